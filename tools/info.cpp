// grainray info: what this build and this machine can do.
#include <cstdio>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tbb/version.h>

#include "commands.hpp"
#include "grainray/neighbors.hpp"
#include "grainray/scene.hpp"
#include "setup.hpp"

namespace grainray::cli {
namespace {

/// The widest vector instructions of this machine; the contact loop uses them, whatever the rest was built for.
std::string vector_level() {
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx512f") ? "AVX-512" : __builtin_cpu_supports("avx2") ? "AVX2" : "SSE2";
#elif defined(__aarch64__)
    return "NEON";
#else
    return "not known";
#endif
}

void print_backends(Device device) {
    for (const BackendInfo& info : search_backends(device))
        if (info.name != "rays-published")
            fmt::print("  search {:<9} {}{}\n", info.name, info.available ? "" : "not available: ", info.reason);
}

void print_libraries() {
    fmt::print("libraries    oneTBB {}.{}, fmt {}.{}.{}, CLI11 {}, nlohmann_json {}.{}.{}, {}\n", TBB_VERSION_MAJOR, TBB_VERSION_MINOR,
               FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100, CLI11_VERSION, NLOHMANN_JSON_VERSION_MAJOR,
               NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH, GRAINRAY_LIBRARIES);
}

int info(bool schema) {
    if (schema) {
        fmt::print("{}", schema_text());
        return done;
    }
    fmt::print("grainray     {}\n", GRAINRAY_VERSION);
    fmt::print("device cpu   {} threads, {}, {}\n", ThreadLimit::count(), vector_level(), bytes_text(machine_memory_bytes()));
    print_backends(Device::cpu);
    fmt::print("device cuda  {}\n", cuda_status());
    print_backends(Device::cuda);
    fmt::print("runs         on {}\n", cuda_available() ? "cuda (--device cpu for the CPU)" : "cpu");
    print_libraries();
    return done;
}

}  // namespace

void add_info(CLI::App& app, Action& chosen) {
    CLI::App* command = app.add_subcommand("info", "Devices, search back ends and why others are not there");
    const auto schema = std::make_shared<bool>(false);
    command->add_flag("--schema", *schema, "Print every key of a scene file: type, unit, default, meaning");
    command->footer("Example: grainray info --schema | less");
    command->callback([schema, &chosen] { chosen = [schema] { return info(*schema); }; });
}

}  // namespace grainray::cli
