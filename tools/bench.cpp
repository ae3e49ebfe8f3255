// grainray bench: measurements, as a table for people and as JSON for programs.
#include <CLI/CLI.hpp>

#include "commands.hpp"
#include "grainray/core.hpp"

namespace grainray::cli {

void add_bench(CLI::App& app, Action& chosen) {
    CLI::App* command = app.add_subcommand("bench", "Measure time steps or the neighbour search");
    command->footer("Example: grainray bench step --scene collapse --steps 500 --json step.json");
    command->callback([&chosen] { if (!chosen) chosen = []() -> int { throw InputError("bench: say what to measure: bench step or bench neighbors; see grainray bench --help"); }; });  // a command below has chosen first
    add_bench_step(*command, chosen);
    add_bench_neighbors(*command, chosen);
}

}  // namespace grainray::cli
