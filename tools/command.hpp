// A subcommand and its options. CLI11 stays in command.cpp, because including it takes the compiler several seconds.
#pragma once

#include <string>
#include <vector>

#include "commands.hpp"

namespace grainray::cli {

struct EngineOptions;

/// Variables of options live as long as the command line: in a shared_ptr that the action holds too.
class Command {
public:
    Command(CLI::App& parent, Action& chosen, const std::string& name, const std::string& text);
    Command(CLI::App& command, Action& chosen) : command_(command), chosen_(chosen) {}

    /// The argument without a name. T: std::filesystem::path.
    template <class T>
    void argument(const std::string& name, T& value, const std::string& text);
    /// Any number of arguments, also none.
    void arguments(const std::string& name, std::vector<std::string>& values, const std::string& text);
    /// T: std::string; std::filesystem::path, which must not be "", such as a variable of the shell that is not set; std::optional of std::int64_t or double.
    template <class T>
    void option(const std::string& name, T& value, const std::string& type, const std::string& text);
    /// The help shows what `value` is before. type "": what CLI11 calls it. T: std::string, int, double.
    template <class T>
    void option_with_default(const std::string& name, T& value, const std::string& type, const std::string& text);
    void flag(const std::string& name, bool& value, const std::string& text);
    /// --device, --search, --threads, --set
    void engine_options(EngineOptions&);
    /// Any number of values with commas between. T: std::string, std::int64_t, double.
    template <class T>
    void list(const std::string& name, std::vector<T>& values, const std::string& type, const std::string& text);
    void footer(const std::string&);
    /// What is done where the command line ends with this command.
    void action(Action);

    CLI::App& app() { return command_; }

private:
    CLI::App& command_;
    Action& chosen_;
};

/// What the command line asks for, --help and --version included; none where it names no command. Throws InputError with
/// one sentence; unknown commands and options come with the nearest name.
Action parse_command_line(int argc, char** argv, void (*add_commands)(CLI::App&, Action& chosen));

}  // namespace grainray::cli
