// How long candidate lists on CUDA may become, and the device memory that follows from it.
#pragma once

#include "grainray/simulation.hpp"

namespace grainray {

/// Entries a particle of the longest list that is planned for. Lists of violent phases would grow past it for a few per cent
/// of speed; they are made for fewer steps instead.
inline constexpr double planned_entries = 18;

}  // namespace grainray
