#include "insertion/vacancy.hpp"

#include <algorithm>

namespace grainray {
namespace {

/// Room for the centres of all spheres that reach into the region; where it wraps round, exactly the domain.
Box grid_box(const InletRegion& region, const Vec3d& origin, double largest_radius) {
    Box box{region.bounds.lower - origin, region.bounds.upper - origin};
    for (int a = 0; a < 3; ++a)
        if (!region.wraps[static_cast<std::size_t>(a)]) box.lower[a] -= largest_radius, box.upper[a] += largest_radius;
    return box;
}

/// Centre above the ground by more than the radius, as far as the facet right below it tells.
bool above_ground(const FacetShapes& shapes, const Surface& s, const Vec3d& x, double radius) {
    const double u = (x.x - s.lower.x) / s.width.x, v = (x.y - s.lower.y) / s.width.y;
    if (!(u >= 0 && v >= 0 && u < s.nx && v < s.ny)) return true;
    const auto i = static_cast<std::int32_t>(u), j = static_cast<std::int32_t>(v);
    const int half = u - i >= v - j ? 0 : 1;
    if (!shapes.has_half_cell(s, i, j, half)) return true;
    const Triangle t = shapes.half_cell(s, i, j, half);
    return dot(t.normal, x - t.a) > radius;
}

}  // namespace

const Facets& Obstacles::facets() const { return state_.facets.surfaces.device() == Device::cpu ? state_.facets : copy_; }

void Obstacles::update(double time) {
    planes_.clear();
    for (const Plane& plane : scene_.planes) planes_.push_back(plane_at(plane, time));
    const Facets& there = state_.facets;
    if (there.surfaces.device() == Device::cpu || there.count() == 0) return;
    if (copy_.count() == 0) {
        copy_.surfaces.assign(there.surfaces);
        copy_.triangles.assign(there.triangles);
        copy_.cell_offsets.assign(there.cell_offsets);
        copy_.cell_triangles.assign(there.cell_triangles);
        copy_.heights.assign(there.heights);
    }
    copy_.now.assign(there.now);
}

bool Obstacles::touch(const Vec3d& centre, double radius) const {
    const Vec3d world = centre + state_.particles.scale.origin;
    for (const PlaneState& plane : planes_)
        if (dot(plane.normal, world - plane.point) < radius) return true;
    for (std::uint32_t q = 0; q < facets().count(); ++q)
        if (surface_touches(q, centre, radius)) return true;
    return false;
}

bool Obstacles::surface_touches(std::uint32_t q, const Vec3d& centre, double radius) const {
    const FacetShapes shapes = shapes_of(facets());
    const Surface& surface = shapes.surfaces[q];
    const Vec3d x = facets().now.data()[q].into(centre);
    bool touches = surface.terrain && !above_ground(shapes, surface, x, radius);
    shapes.for_each_near(q, x, radius, [&](std::uint32_t id) {
        Triangle t = shapes.facet(surface, id);
        touches = touches || shapes.section_of(surface, id, t, x, radius).share > 0;
    });
    return touches;
}

Vacancy::Vacancy(const InletRegion& region, const std::vector<Resident>& residents, const Obstacles& obstacles, const State& state,
                 double largest_radius, std::size_t newcomers)
    : obstacles_(obstacles), scale_(state.particles.scale), period_(convert<double>(state.period) * scale_.unit), wraps_(region.wraps),
      box_(grid_box(region, scale_.origin, largest_radius)), grid_(box_, wraps_, largest_radius, residents.size() + newcomers) {
    for (const Resident& resident : residents) add_images(resident);
}

/// Those images of a particle that are in the box; along an axis that wraps round the grid knows them itself.
void Vacancy::add_images(const Resident& resident) {
    const Vec3d x = scale_.local(resident.position);
    const double radius = resident.radius * scale_.unit;
    const auto images = [&](int a) { return period_[a] > 0 && !wraps_[static_cast<std::size_t>(a)] ? 1 : 0; };
    for (int i = -images(0); i <= images(0); ++i)
        for (int j = -images(1); j <= images(1); ++j)
            for (int k = -images(2); k <= images(2); ++k) {
                const Vec3d image = x + Vec3d{i * period_.x, j * period_.y, k * period_.z};
                bool inside = true;
                for (int a = 0; a < 3; ++a) inside = inside && (wraps_[static_cast<std::size_t>(a)] || (image[a] >= box_.lower[a] && image[a] <= box_.upper[a]));
                if (inside) grid_.insert(image, radius);
            }
}

/// Two units more than the radius, so that no rounding lets spheres touch.
bool Vacancy::has_room(const Vec3l& position, double radius) const {
    const Vec3d x = scale_.local(position);
    const double wide = radius + 2 * scale_.unit;
    return !grid_.overlaps(x, wide) && !obstacles_.touch(x, wide);
}

void Vacancy::add(const Vec3l& position, double radius) { grid_.insert(scale_.local(position), radius); }

}  // namespace grainray
