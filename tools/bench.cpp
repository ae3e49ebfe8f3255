// grainray bench: measurements, as a table for people and as JSON for programs.
#include "command.hpp"
#include "grainray/core.hpp"

namespace grainray::cli {

void add_bench(CLI::App& app, Action& chosen) {
    Command command(app, chosen, "bench", "Measure time steps or the neighbour search");
    command.footer("Example: grainray bench step --scene collapse --steps 500 --json step.json");
    command.action([]() -> int { throw InputError("bench: say what to measure: bench step or bench neighbors; see grainray bench --help"); });
    add_bench_step(command.app(), chosen);
    add_bench_neighbors(command.app(), chosen);
}

}  // namespace grainray::cli
