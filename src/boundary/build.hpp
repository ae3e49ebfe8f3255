// Surfaces of a scene onto the device, and where they are in the steps ahead.
#pragma once

#include <optional>

#include "boundary/facets.hpp"
#include "grainray/particles.hpp"
#include "grainray/scene.hpp"

namespace grainray {

/// Loads every mesh and the terrain. Throws InputError.
void build_facets(const Scene&, const PositionScale&, Facets&);
/// Fills Facets::now with the places at step, step + 1, ... step + count - 1.
void place_facets(const Scene&, const PositionScale&, std::uint64_t step, std::uint32_t count, Facets&);
bool facets_move(const Scene&);
/// The sides of an open terrain, and below its lowest point: a particle wholly beyond has left it. upper.z has no meaning.
std::optional<Box> open_terrain(const Scene&, const Facets&);

}  // namespace grainray
