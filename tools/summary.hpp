// DIR/summary.json: what was run, how fast, and what came out.
#pragma once

#include <string>

#include "grainray/simulation.hpp"

namespace grainray::cli {

/// What the simulation itself does not know.
struct RunFacts {
    std::string status;   ///< done, interrupted or failed
    std::string message;  ///< why it failed
    std::string device_reason;
    std::uint64_t first_step = 0;
    double wall_seconds = 0;  ///< of stepping and output; making the simulation does not count
    int threads = 0;
    double device_forecast_bytes = 0;  ///< of GPU memory at its peak
};

std::string summary_text(const Simulation&, const Scene&, const RunFacts&);
std::string hash_text(std::uint64_t);

}  // namespace grainray::cli
