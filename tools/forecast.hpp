// How much memory and disk a scene will need, before anything is placed or run.
#pragma once

#include <cstdint>
#include <vector>

#include "grainray/scene.hpp"

namespace grainray::cli {

/// Particles of each group; a fill up to a solid fraction and a file are not known before they are placed (0).
std::vector<double> expected_counts(const Scene&);

struct Forecast {
    double memory_bytes = 0;      ///< of the simulation once the grains lie close
    double peak_bytes = 0;        ///< of the process while it writes a frame or a checkpoint
    double frame_bytes = 0;       ///< of one frame on disk
    double disk_bytes = 0;        ///< of all output
};
/// steps: how many are run.
Forecast forecast(const Scene&, double particles, std::uint64_t steps);

}  // namespace grainray::cli
