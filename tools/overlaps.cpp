#include "overlaps.hpp"

#include <algorithm>
#include <cmath>

#include "boundary/build.hpp"
#include "grainray/neighbors.hpp"

namespace grainray::cli {
namespace {

/// x y z reach, about `centre`, so that single precision is enough.
std::vector<float> spheres_about(const Vec3d& centre, const InitialState& s) {
    std::vector<float> spheres;
    spheres.reserve(4 * s.size());
    for (std::size_t i = 0; i < s.size(); ++i) {
        for (int a = 0; a < 3; ++a) spheres.push_back(static_cast<float>(s.positions[i][a] - centre[a]));
        spheres.push_back(static_cast<float>(s.radii[i]));
    }
    return spheres;
}

Vec3d periodic_difference(const Scene& scene, Vec3d d) {
    for (int a = 0; a < 3; ++a) {
        if (!scene.domain.periodic[a] || !scene.domain.box) continue;
        const double width = scene.domain.box->extent()[a];
        d[a] -= width * std::round(d[a] / width);
    }
    return d;
}

/// Every pair that touches, found by the search that the simulation uses, once each.
NeighborList touching_pairs(const Scene& scene, const InitialState& s, const Vec3d& centre) {
    SearchOptions options;
    options.kind = ListKind::half;
    options.ascending = false;
    for (int a = 0; a < 3; ++a) {
        if (!scene.domain.periodic[a] || !scene.domain.box) continue;
        options.lower[a] = static_cast<float>(scene.domain.box->lower[a] - centre[a]);
        options.period[a] = static_cast<float>(scene.domain.box->extent()[a]);
    }
    const std::vector<float> spheres = spheres_about(centre, s);
    const float* first = spheres.data();
    NeighborList list;
    NeighborSearch(Device::cpu, options).find(Points{first, first + 1, first + 2, 4, first + 3, 4, 0, nullptr, s.size()}, list);
    return list;
}

void find_pairs(const Scene& scene, const InitialState& s, Overlaps& found) {
    const Box box = *bounds(s);
    const NeighborList list = touching_pairs(scene, s, (box.lower + box.upper) * 0.5);
    const auto offsets = list.offsets.view();
    const auto neighbors = list.neighbors.view();
    for (std::uint32_t i = 0; i < s.size(); ++i)
        for (std::uint64_t e = offsets[i]; e < offsets[i + 1]; ++e) {
            const std::uint32_t j = neighbors[e];
            const double overlap = s.radii[i] + s.radii[j] - length(periodic_difference(scene, s.positions[i] - s.positions[j]));
            if (overlap <= 0) continue;
            ++found.pairs;
            const double ratio = overlap / std::min(s.radii[i], s.radii[j]);
            if (!found.worst_pair || ratio > found.worst_pair->ratio) found.worst_pair = {std::min(i, j), std::max(i, j), overlap, ratio};
        }
}

void find_planes(const Scene& scene, const InitialState& s, Overlaps& found) {
    for (std::size_t p = 0; p < scene.planes.size(); ++p) {
        const PlaneState plane = plane_at(scene.planes[p], 0);
        for (std::uint32_t i = 0; i < s.size(); ++i) {
            const double overlap = s.radii[i] - dot(plane.normal, s.positions[i] - plane.point), ratio = overlap / s.radii[i];
            if (overlap <= 0) continue;
            ++found.with_planes;
            if (!found.worst_plane || ratio > found.worst_plane->ratio) found.worst_plane = {i, p, overlap, ratio};
        }
    }
}

/// A particle whose centre has passed a mesh belongs to its other side, so no overlap with a mesh is above the radius.
void find_surfaces(const Scene& scene, const InitialState& s, Overlaps& found) {
    if (scene.meshes.empty() && !scene.terrain) return;
    const Box box = *bounds(s);
    const PositionScale scale{0x1p-30, (box.lower + box.upper) * 0.5};  // heights are rounded to the unit
    Facets facets(Device::cpu);
    build_facets(scene, scale, facets);
    place_facets(scene, scale, 0, 1, facets);
    const FacetShapes shapes = shapes_of(facets);
    for (std::uint32_t q = 0; q < facets.count(); ++q) {
        const Surface& surface = shapes.surfaces[q];
        for (std::uint32_t i = 0; i < s.size(); ++i) {
            const Vec3d x = facets.now.data()[q].into(s.positions[i] - scale.origin);
            double deepest = 0, pressed = 0;
            shapes.for_each_near(q, x, s.radii[i], [&](std::uint32_t id) {
                Triangle t = shapes.facet(surface, id);
                const Section at = shapes.section_of(surface, id, t, x, s.radii[i]);
                if (at.rim) return;
                const double depth = s.radii[i] - (surface.terrain ? at.distance : std::fabs(at.distance));
                pressed += at.share * depth;  // a ridge that is hardly touched pushes hardly, however deep below its flank's plane
                if (at.share > 0.5f) deepest = std::max(deepest, depth);
            });
            deepest = std::max(deepest, pressed);
            if (!(deepest > 0)) continue;
            ++found.with_surfaces;
            const double ratio = deepest / s.radii[i];
            const std::string what = surface.terrain ? "the terrain" : "mesh '" + scene.meshes[q].name + "'";
            if (!found.worst_surface || ratio > found.worst_surface->ratio) found.worst_surface = {i, what, deepest, ratio};
        }
    }
    if (!scene.terrain) return;
    const ElevationGrid ground = load_ground(scene);
    for (std::uint32_t i = 0; i < s.size() && !found.below_terrain; ++i)
        if (ground.height(s.positions[i].x, s.positions[i].y) > s.positions[i].z) found.below_terrain = i;
}

}  // namespace

std::optional<Box> bounds(const InitialState& s) {
    if (s.size() == 0) return std::nullopt;
    Box box{s.positions[0], s.positions[0]};
    for (std::size_t i = 0; i < s.size(); ++i)
        for (int a = 0; a < 3; ++a) {
            box.lower[a] = std::min(box.lower[a], s.positions[i][a] - s.radii[i]);
            box.upper[a] = std::max(box.upper[a], s.positions[i][a] + s.radii[i]);
        }
    return box;
}

Overlaps initial_overlaps(const Scene& scene, const InitialState& s) {
    Overlaps found;
    if (s.size() == 0) return found;
    find_pairs(scene, s, found);
    find_planes(scene, s, found);
    find_surfaces(scene, s, found);
    return found;
}

}  // namespace grainray::cli
