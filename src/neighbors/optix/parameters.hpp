// What the host tells the OptiX programs: one declaration for both.
#pragma once

#include <optix.h>

#include "neighbors/rays/boxes.hpp"
#include "neighbors/rays/slots.hpp"

namespace grainray::optix {

struct Parameters {
    OptixTraversableHandle boxes;
    View<const neighbors::Sphere> points;   ///< of the boxes, in their order
    View<const neighbors::Sphere> sources;  ///< of the rays
    std::size_t first;                      ///< ray of launch index 0
    neighbors::rays::Frame frame;
    neighbors::rays::Bounds bounds;         ///< of the boxes: an image beyond them meets nobody
    bool periodic;
    neighbors::rays::Classes classes;       ///< boxes.hpp
    View<const std::uint32_t> larger;       ///< points of the boxes after one for each point
    neighbors::rays::Slots slots;
    View<std::uint32_t> doubtful;           ///< rows.hpp
};

}  // namespace grainray::optix
