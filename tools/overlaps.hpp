// Particles that touch or lie inside each other, or behind planes, before the first step.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "grainray/scene.hpp"

namespace grainray::cli {

struct PairOverlap {
    std::uint32_t a, b;
    double overlap, ratio;  ///< m; over the smaller radius
};
struct PlaneOverlap {
    std::uint32_t particle;
    std::size_t plane;
    double overlap, ratio;  ///< m; over the radius
};
struct SurfaceOverlap {
    std::uint32_t particle;
    std::string surface;    ///< "mesh 'NAME'" or "the terrain"
    double overlap, ratio;  ///< m; over the radius
};
struct Overlaps {
    std::uint64_t pairs = 0, with_planes = 0, with_surfaces = 0;
    std::optional<SurfaceOverlap> worst_surface;
    std::optional<std::uint32_t> below_terrain;  ///< a particle whose centre lies under the ground
    std::optional<PairOverlap> worst_pair;
    std::optional<PlaneOverlap> worst_plane;
};
Overlaps initial_overlaps(const Scene&, const InitialState&);

/// Bounds of the sphere surfaces; nothing for no particles.
std::optional<Box> bounds(const InitialState&);

}  // namespace grainray::cli
