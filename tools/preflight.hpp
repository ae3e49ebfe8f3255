// What `check` looks at and `run` insists on before it writes anything.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "forecast.hpp"
#include "grainray/simulation.hpp"
#include "overlaps.hpp"

namespace grainray::cli {

struct Finding {
    bool refused;      ///< cannot work; else a warning
    std::string text;  ///< one sentence with the field to change
};

enum class StepVerdict { ok, risky, unstable };
StepVerdict verdict(const CriticalStep&, double dt);

struct Preflight {
    std::vector<CriticalStep> steps;
    Overlaps overlaps;
    Forecast needs;
    std::vector<Finding> findings;
    const Finding* first_refusal() const;
    std::size_t warnings() const;
};

/// Places the particles of a scene that fits into this machine's memory; InputError where it cannot fit.
InitialState place_checked(const Scene&);
/// restarted: positions come from a checkpoint, so those of the scene are not looked at.
Preflight inspect(const Scene&, const InitialState&, bool restarted = false);
/// Warnings to stderr; throws InputError for what is refused.
void insist(const Preflight&, bool quiet);
/// Adds a warning where the output is forecast to fill the disk of `folder`.
void inspect_disk(const std::filesystem::path& folder, Preflight&);

}  // namespace grainray::cli
