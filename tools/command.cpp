#include "command.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "scene/suggest.hpp"
#include "setup.hpp"

namespace grainray::cli {
namespace {

/// The subcommand the user got to: `grainray bench step` rather than `grainray`.
const CLI::App& deepest(const CLI::App& app) {
    for (const CLI::App* sub : app.get_subcommands()) return deepest(*sub);
    return app;
}

std::vector<std::string> option_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

std::vector<std::string> command_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; })) names.push_back(sub->get_name());
    return names;
}

std::string nearest(std::string_view word, const std::vector<std::string>& known) {
    return scene::did_you_mean(word, {known.begin(), known.end()});
}

std::string one_line(std::string text) {
    for (char& c : text)
        if (c == '\n') c = ' ';
    while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
    return text;
}

/// "; an integer is wanted" where CLI11 could not read the value of an option.
std::string wanted(const CLI::App& at, const CLI::ParseError& error) {
    if (error.get_name() != "ConversionError") return "";
    const std::string text = std::string(error.what()) + ' ';
    for (const CLI::Option* option : at.get_options())
        for (const std::string& name : option->get_lnames())
            if (text.find("--" + name + ' ') != std::string::npos) {
                const std::string type = option->get_type_name();
                return type == "INT" || type.starts_with('N') ? "; an integer is wanted" : "; a number is wanted";
            }
    return "";
}

CLI::Validator not_empty() {
    return CLI::Validator([](std::string& text) { return text.empty() ? std::string("the name is empty") : std::string(); }, "");
}

/// Each takes one argument, so a scene may follow.
void add_overrides(CLI::App& app, std::vector<std::string>& overrides) {
    app.add_option("--set", overrides, "Change a key of the scene, as often as needed: --set materials.grain.friction=0.3")
        ->type_name("KEY=VALUE")->allow_extra_args(false);
}

/// One sentence for what CLI11 found wrong.
std::string parse_mistake(const CLI::App& app, const CLI::ParseError& error) {
    const CLI::App& at = deepest(app);
    const std::string help = fmt::format("see {} --help", &at == &app ? app.get_name() : app.get_name() + " " + at.get_display_name());
    std::vector<std::string> extras = app.remaining(true);
    std::string_view first;
    for (const std::string& word : extras)
        if (word.starts_with('-') && word != "--") {
            const std::string name = word.substr(0, word.find('='));
            return fmt::format("unknown option '{}'{} For all options {}", name, nearest(name, option_names(at)), help);
        } else if (first.empty()) first = word;
    if (first.empty()) return fmt::format("{}{}; {}", one_line(error.what()), wanted(at, error), help);
    if (!at.get_subcommands([](const CLI::App*) { return true; }).empty())
        return fmt::format("unknown command '{}'{} For all commands {}", first, nearest(first, command_names(at)), help);
    return fmt::format("unexpected argument '{}'; {}", first, help);
}

}  // namespace

Command::Command(CLI::App& parent, Action& chosen, const std::string& name, const std::string& text) : command_(*parent.add_subcommand(name, text)), chosen_(chosen) {}

template <class T>
void Command::argument(const std::string& name, T& value, const std::string& text) {
    command_.add_option(name, value, text)->required()->type_name("");
}
template void Command::argument(const std::string&, std::filesystem::path&, const std::string&);

void Command::arguments(const std::string& name, std::vector<std::string>& values, const std::string& text) { command_.add_option(name, values, text); }

template <class T>
void Command::option(const std::string& name, T& value, const std::string& type, const std::string& text) {
    CLI::Option* option = command_.add_option(name, value, text)->type_name(type);
    if constexpr (std::is_same_v<T, std::filesystem::path>) option->check(not_empty());
}
template void Command::option(const std::string&, std::string&, const std::string&, const std::string&);
template void Command::option(const std::string&, std::filesystem::path&, const std::string&, const std::string&);
template void Command::option(const std::string&, std::optional<std::int64_t>&, const std::string&, const std::string&);
template void Command::option(const std::string&, std::optional<double>&, const std::string&, const std::string&);

template <class T>
void Command::option_with_default(const std::string& name, T& value, const std::string& type, const std::string& text) {
    CLI::Option* option = command_.add_option(name, value, text);
    if (!type.empty()) option->type_name(type);
    option->capture_default_str();
}
template void Command::option_with_default(const std::string&, std::string&, const std::string&, const std::string&);
template void Command::option_with_default(const std::string&, int&, const std::string&, const std::string&);
template void Command::option_with_default(const std::string&, double&, const std::string&, const std::string&);

void Command::flag(const std::string& name, bool& value, const std::string& text) { command_.add_flag(name, value, text); }

void Command::engine_options(EngineOptions& options) {
    option_with_default("--device", options.device, "", "auto, cpu or cuda");
    option_with_default("--search", options.search, "", "Neighbour search: auto, brute, cells or rays");
    option_with_default("--threads", options.threads, "", "CPU threads; 0: all");
    add_overrides(command_, options.set);
}

template <class T>
void Command::list(const std::string& name, std::vector<T>& values, const std::string& type, const std::string& text) {
    command_.add_option(name, values, text)->delimiter(',')->allow_extra_args(false)->type_name(type);
}
template void Command::list(const std::string&, std::vector<std::string>&, const std::string&, const std::string&);
template void Command::list(const std::string&, std::vector<std::int64_t>&, const std::string&, const std::string&);
template void Command::list(const std::string&, std::vector<double>&, const std::string&, const std::string&);

void Command::footer(const std::string& text) { command_.footer(text); }

/// A command below this one has chosen first.
void Command::action(Action action) {
    command_.callback([&chosen = chosen_, action = std::move(action)] {
        if (!chosen) chosen = action;
    });
}

Action parse_command_line(int argc, char** argv, void (*add_commands)(CLI::App&, Action& chosen)) {
    CLI::App app("grainray: granular material, grain by grain", "grainray");
    app.set_version_flag("--version", "grainray " GRAINRAY_VERSION);
    Action chosen;
    add_commands(app, chosen);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        if (e.get_exit_code() != 0) throw InputError(parse_mistake(app, e));
        app.exit(e);  // prints what --help or --version asked for
        return [] { return done; };
    }
    return chosen;
}

}  // namespace grainray::cli
