#include "overlaps.hpp"

#include <algorithm>
#include <cmath>

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
    return found;
}

}  // namespace grainray::cli
