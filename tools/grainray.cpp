// The command line: reads it, runs the subcommand, turns every error into one line and an exit status.
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <new>
#include <system_error>

#include <fmt/format.h>

#include "command.hpp"
#include "grainray/core.hpp"

namespace grainray::cli {
namespace {

int report(std::string message, int status) {
    for (char& c : message)
        if (c == '\n') c = ' ';
    fmt::print(stderr, "grainray: {}\n", message);
    return status;
}

void add_validate(CLI::App& app, Action& chosen) {
    struct Options {
        std::vector<std::string> only;
        bool quick = false;
    };
    Command command(app, chosen, "validate", "Run analytic and published cases: expected, got, tolerance, pass");
    const auto options = std::make_shared<Options>();
    command.arguments("CASE", options->only, "Only these cases; none: all");
    command.flag("--quick", options->quick, "Leave out the cases that take long");
    command.footer("Example: grainray validate --quick");
    command.action([options] { return run_validate(options->only, options->quick); });
}

void add_commands(CLI::App& app, Action& chosen) {
    Command(app, chosen).footer("Start with: grainray check examples/column_collapse.toml\n"
                                "then:       grainray run examples/column_collapse.toml --out column\n"
                                "Exit status: 0 done; 1 the simulation failed; 2 the input is wrong; 130 interrupted, state saved.");
    add_run(app, chosen);
    add_check(app, chosen);
    add_info(app, chosen);
    add_render(app, chosen);
    add_deposit(app, chosen);
    add_terrain(app, chosen);
    add_bench(app, chosen);
    add_validate(app, chosen);
}

/// What was printed may be lost, on a full disk for example, only when the last of it is written.
int written(int status) {
    std::cout.flush();
    if (std::fflush(stdout) == 0 && !std::ferror(stdout) && std::cout) return status;
    const std::string why = errno ? ": " + std::generic_category().message(errno) : "";
    return report("standard output cannot be written" + why, status == done ? simulation_failed : status);
}

int parse_and_run(int argc, char** argv) {
    const Action chosen = parse_command_line(argc, argv, add_commands);
    if (!chosen) return report("no command given; see grainray --help", input_wrong);
    return written(chosen());
}

}  // namespace
}  // namespace grainray::cli

int main(int argc, char** argv) {
    using namespace grainray;
    std::signal(SIGXFSZ, SIG_IGN);  // a file size limit is then an error of write(), which we explain
    try {
        return cli::parse_and_run(argc, argv);
    } catch (const InputError& e) {
        return cli::report(e.what(), cli::input_wrong);
    } catch (const std::bad_alloc&) {
        return cli::report("out of memory; use fewer particles or a machine with more memory", cli::simulation_failed);
    } catch (const std::exception& e) {
        return cli::report(e.what(), cli::simulation_failed);
    }
}
