// The subcommands of `grainray`. Each adds itself to the command line; what the user chose is run after parsing.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace grainray::cli {

/// Exit statuses of the command.
enum Status { done = 0, simulation_failed = 1, input_wrong = 2, interrupted = 130 };

/// Set by the subcommand that the command line names; returns the exit status.
using Action = std::function<int()>;

void add_run(CLI::App&, Action& chosen);
void add_check(CLI::App&, Action& chosen);
void add_info(CLI::App&, Action& chosen);
void add_terrain(CLI::App&, Action& chosen);
void add_render(CLI::App&, Action& chosen);
void add_deposit(CLI::App&, Action& chosen);
void add_bench(CLI::App&, Action& chosen);            ///< and below it:
void add_bench_step(CLI::App& bench, Action& chosen);
void add_bench_neighbors(CLI::App& bench, Action& chosen);

/// `grainray validate`: analytic and published cases as one table. only: names of cases, empty for all. Exit status.
int run_validate(const std::vector<std::string>& only, bool quick);

}  // namespace grainray::cli
