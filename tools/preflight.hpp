// What `check` looks at and `run` insists on before it writes anything.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "forecast.hpp"
#include "grainray/simulation.hpp"
#include "insertion/feeder.hpp"
#include "overlaps.hpp"

namespace grainray::cli {

enum class Weight { note, warning, refused };

struct Finding {
    Weight weight;     ///< refused: cannot work
    std::string text;  ///< one sentence with the field to change
};

enum class StepVerdict { ok, risky, unstable };
StepVerdict verdict(const CriticalStep&, double dt);

struct Preflight {
    std::vector<CriticalStep> steps;
    Overlaps overlaps;
    std::vector<StreamForecast> streams;  ///< of the scene's, until the last step
    double most_particles = 0;            ///< at the end, if none is taken out
    Forecast needs;
    std::vector<MemoryPart> device;  ///< GPU memory by part; empty on the CPU
    double device_bytes() const;     ///< all of it
    std::vector<Finding> findings;
    const Finding* first_refusal() const;
    std::size_t warnings() const;
};

/// Places the particles of a scene that fits into this machine's memory; InputError where it cannot fit.
InitialState place_checked(const Scene&);
/// What a run does with a scene besides running it from its start to its end.
struct RunRange {
    bool restarted = false;             ///< positions come from a checkpoint: those of the scene are not looked at
    std::optional<std::uint64_t> asked;  ///< --steps: the duration is not looked at
    std::uint64_t first = 0;            ///< step it starts from
    std::uint64_t last(const Scene&) const;  ///< step it ends at, at least the first
};
Preflight inspect(const Scene&, const InitialState&, const RunRange& = {});
/// Forecasts the GPU memory of a run with `options`, and refuses one that does not fit.
void inspect_device(const Scene&, const InitialState&, const SimulationOptions&, Preflight&);
/// One sentence with the figure and the remedy where `needed` bytes for so many particles are more than are free.
std::optional<std::string> device_refusal(double needed, double free, double particles);
/// Warnings and notes to stderr; throws InputError for what is refused.
void insist(const Preflight&, bool quiet);
/// Adds a warning where the output is forecast to fill the disk of `folder`.
void inspect_disk(const std::filesystem::path& folder, Preflight&);

}  // namespace grainray::cli
