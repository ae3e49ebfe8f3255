#include "insertion/inlet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "surfaces/surfaces.hpp"

namespace grainray {
namespace {

constexpr std::uint64_t room_attempts = 20000;  // places tried for the largest particle before the run

Vec3d direction_of(const Scene& scene, const ParticleStream& stream) {
    const Vec3d way = stream.velocity == Vec3d{} ? scene.gravity : stream.velocity;
    return way * (1 / length(way));
}

/// When v t + g t^2 / 2 has first gone `distance` one way or the other.
double time_to_go(double distance, double v, double g) {
    if (v < 0 || (v == 0 && g < 0)) v = -v, g = -g;
    if (g == 0) return v > 0 ? distance / v : INFINITY;
    if (g > 0) return (std::sqrt(v * v + 2 * g * distance) - v) / g;
    const double turned_back = v * v + 2 * g * distance;  // below 0: it falls back before it gets there
    return turned_back >= 0 ? (v - std::sqrt(turned_back)) / -g : (v + std::sqrt(v * v - 2 * g * distance)) / -g;
}

class BoxRegion : public InletRegion {
public:
    BoxRegion(const Box& box, const Domain& domain) {
        bounds = box;
        volume = box.extent().x * box.extent().y * box.extent().z;
        for (int a = 0; a < 3; ++a)
            wraps[static_cast<std::size_t>(a)] = domain.periodic[static_cast<std::size_t>(a)] && box.lower[a] == domain.box->lower[a] && box.upper[a] == domain.box->upper[a];
    }
    std::optional<Vec3d> place(const scene::Random& random, std::uint64_t k, double radius) const override {
        Vec3d x;
        for (int a = 0; a < 3; ++a) {
            const double inset = wraps[static_cast<std::size_t>(a)] ? 0 : radius, lower = bounds.lower[a] + inset, upper = bounds.upper[a] - inset;
            x[a] = std::min(lower + (upper - lower) * random.uniform(4 * k + static_cast<std::uint64_t>(a)), upper);
        }
        return x;
    }
};

struct Flat {
    double x, y;
};

/// The layer that a surface sweeps along a direction.
class SweptRegion : public InletRegion {
public:
    SweptRegion(const TriangleMesh& surface, const Vec3d& way, double depth) : way_(way), depth_(depth) {
        const int axis = std::fabs(way.x) < 0.6 ? 0 : 1;  // any that is not along the way
        across_ = cross(way, Vec3d{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, 0});
        across_ *= 1 / length(across_);
        up_ = cross(way, across_);
        bounds = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
        std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
        double sum = 0;
        for (const auto& t : surface.triangles) {
            const Vec3d a = surface.vertices[t[0]], b = surface.vertices[t[1]], c = surface.vertices[t[2]], twice = cross(b - a, c - a);
            const double facing = std::fabs(dot(twice, way)) / length(twice);
            facets_.push_back({a, b, c, facing});
            cumulative_.push_back(sum += facing > least_facing ? 0.5 * std::fabs(dot(twice, way)) : 0);
            for (const Vec3d& corner : {a, b, c})
                for (const Vec3d& x : {corner, corner + way * depth}) include(x);
            for (std::size_t k = 0; k < 3; ++k) ++edges[std::minmax(t[k], t[(k + 1) % 3])];
        }
        volume = sum * depth;
        for (const auto& [edge, count] : edges)
            if (count == 1) rims_.push_back({flat(surface.vertices[edge.first]), flat(surface.vertices[edge.second])});
    }
    std::optional<Vec3d> place(const scene::Random& random, std::uint64_t k, double radius) const override {
        const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), random.uniform(4 * k) * cumulative_.back());
        const Facet& f = facets_[static_cast<std::size_t>(std::min(found, cumulative_.end() - 1) - cumulative_.begin())];
        const double inset = radius / f.facing;  // so that the sphere is clear of the facet, and of where it has been swept to
        if (!(2 * inset <= depth_)) return {};
        const double s = std::sqrt(random.uniform(4 * k + 1)), t = random.uniform(4 * k + 2);
        const Vec3d foot = f.a * (1 - s) + f.b * (s * (1 - t)) + f.c * (s * t);
        const Flat p = flat(foot);
        for (const auto& [from, to] : rims_)
            if (square_distance(p, from, to) < radius * radius) return {};
        return foot + way_ * (inset + (depth_ - 2 * inset) * random.uniform(4 * k + 3));
    }

private:
    static constexpr double least_facing = 1e-3;  ///< cosine: facets along the way sweep nothing
    struct Facet {
        Vec3d a, b, c;
        double facing;
    };
    Flat flat(const Vec3d& x) const { return {dot(x, across_), dot(x, up_)}; }
    static double square_distance(const Flat& p, const Flat& from, const Flat& to) {
        const double ex = to.x - from.x, ey = to.y - from.y, square = ex * ex + ey * ey;
        const double along = square > 0 ? std::clamp(((p.x - from.x) * ex + (p.y - from.y) * ey) / square, 0.0, 1.0) : 0;
        const double dx = p.x - from.x - along * ex, dy = p.y - from.y - along * ey;
        return dx * dx + dy * dy;
    }
    void include(const Vec3d& x) {
        for (int a = 0; a < 3; ++a) {
            bounds.lower[a] = std::min(bounds.lower[a], x[a]);
            bounds.upper[a] = std::max(bounds.upper[a], x[a]);
        }
    }

    Vec3d way_, across_, up_;
    double depth_;
    std::vector<Facet> facets_;
    std::vector<double> cumulative_;  ///< areas seen along the way
    std::vector<std::pair<Flat, Flat>> rims_;
};

const Mesh& mesh_of(const Scene& scene, const InletSurface& inlet) {
    if (inlet.mesh.empty()) return inlet.surface;
    for (const Mesh& mesh : scene.meshes)
        if (mesh.name == inlet.mesh) return mesh;
    throw InputError("mesh '" + inlet.mesh + "' of an inlet is not defined in the scene");
}

Vec3d moved(const Mesh& mesh, Vec3d x, double time) {
    x += mesh.translation;
    const MotionState m = motion_at(mesh.motion, time);
    if (m.angle != 0) x = mesh.motion.rotation_point + turned(x - mesh.motion.rotation_point, mesh.motion.rotation_axis, m.angle);
    return x + m.shift;
}

bool inside(const Vec3d& x, const Box& box) {
    return x.x >= box.lower.x && x.y >= box.lower.y && x.z >= box.lower.z && x.x <= box.upper.x && x.y <= box.upper.y && x.z <= box.upper.z;
}

/// The facets chosen, where the mesh stands at the start.
TriangleMesh chosen_facets(const Scene& scene, const ParticleStream& stream, const InletSurface& inlet) {
    const Mesh& mesh = mesh_of(scene, inlet);
    TriangleMesh m = inlet.mesh.empty() ? surfaces::load_surface(scene, mesh, "streams." + stream.name + ".file", nullptr) : load_mesh(scene, mesh);
    if (!inlet.facets) return m;
    std::erase_if(m.triangles, [&](const auto& t) {
        return !std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return inside(moved(mesh, m.vertices[v], 0), *inlet.facets); });
    });
    if (m.triangles.empty())
        throw InputError(place_of(scene, stream, "lower") + ": no facet of the surface lies wholly between lower and upper; move the box (grainray check says where meshes lie)");
    return m;
}

}  // namespace

double sphere_volume(double radius) { return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius; }
double particle_mass(double radius, double density) { return static_cast<float>(sphere_volume(radius) * density); }

std::string place_of(const Scene& scene, const ParticleStream& stream, const std::string& field) {
    const std::string file = scene.file.empty() ? "scene" : scene.file.string();
    return fmt::format("{}: key 'streams.{}{}{}'", file, stream.name, field.empty() ? "" : ".", field);
}

Inlet::Inlet(const Scene& scene, const ParticleStream& stream) : scene_(scene), stream_(stream) {
    if (stream.velocity == Vec3d{} && scene.gravity == Vec3d{})
        throw InputError(place_of(scene, stream, "velocity") + ": nothing carries the particles out of the inlet; give a velocity, as there is no gravity");
    if (const auto* inlet = std::get_if<InletSurface>(&stream.inlet)) surface_ = chosen_facets(scene, stream, *inlet);
    require_room();
}

void Inlet::require_room() const {
    const auto region = at(0);
    if (!(region->volume > 0))
        throw InputError(place_of(scene_, stream_) + ": the inlet has no volume; give a box with three edges, or a surface that faces the way of the particles");
    if (const auto& box = scene_.domain.box)
        for (int a = 0; a < 3; ++a)
            if (region->bounds.lower[a] < box->lower[a] || region->bounds.upper[a] > box->upper[a])
                throw InputError(fmt::format("{}: the inlet reaches from {:.6g} to {:.6g} m along {} and the domain from {:.6g} to {:.6g} m; move the inlet or enlarge the domain",
                                             place_of(scene_, stream_), region->bounds.lower[a], region->bounds.upper[a], "xyz"[a], box->lower[a], box->upper[a]));
    const double largest = largest_radius(stream_.size);
    for (int a = 0; a < 3; ++a)
        if (std::holds_alternative<Box>(stream_.inlet) && 2 * largest > region->bounds.extent()[a])
            throw InputError(fmt::format("{}: the largest particle, {:.4g} m wide, does not fit into the box; enlarge the box or take smaller particles", place_of(scene_, stream_), 2 * largest));
    const scene::Random random(scene_.seed, "streams." + stream_.name, scene::Stream::inlet);
    for (std::uint64_t k = 0; k < room_attempts; ++k)
        if (region->place(random, k, largest)) return;
    throw InputError(fmt::format("{}: {} places were tried in the inlet, and the largest particle, {:.4g} m wide, fits nowhere; enlarge the surface, deepen the layer or take smaller particles",
                                 place_of(scene_, stream_), room_attempts, 2 * largest));
}

std::unique_ptr<InletRegion> Inlet::at(double time) const {
    if (const auto* box = std::get_if<Box>(&stream_.inlet)) return std::make_unique<BoxRegion>(*box, scene_.domain);
    const auto& inlet = std::get<InletSurface>(stream_.inlet);
    TriangleMesh now = surface_;
    for (Vec3d& v : now.vertices) v = moved(mesh_of(scene_, inlet), v, time);
    return std::make_unique<SweptRegion>(now, direction_of(scene_, stream_), inlet.depth);
}

double Inlet::crossing_time() const {
    if (const auto* inlet = std::get_if<InletSurface>(&stream_.inlet)) {
        const Vec3d way = direction_of(scene_, stream_);
        return time_to_go(inlet->depth, dot(stream_.velocity, way), dot(scene_.gravity, way));
    }
    const Vec3d extent = std::get<Box>(stream_.inlet).extent();
    double least = INFINITY;
    for (int a = 0; a < 3; ++a) least = std::min(least, time_to_go(extent[a], stream_.velocity[a], scene_.gravity[a]));
    return least;
}

}  // namespace grainray
