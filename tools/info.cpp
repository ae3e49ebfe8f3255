// grainray info: what this build and this machine can do.
#include <cstdio>

#include <fmt/format.h>
#include <tbb/version.h>

#include "command.hpp"
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
    fmt::print("libraries    oneTBB {}.{}, fmt {}.{}.{}, {}\n", TBB_VERSION_MAJOR, TBB_VERSION_MINOR, FMT_VERSION / 10000, FMT_VERSION / 100 % 100,
               FMT_VERSION % 100, GRAINRAY_LIBRARIES);
}

std::string cuda_version(int version) { return fmt::format("CUDA {}.{}", version / 1000, version % 1000 / 10); }

void print_gpus() {
    const CudaReport report = cuda_report();
    if (report.gpus.empty()) {
        fmt::print("device cuda  {}\n", cuda_status());
        return;
    }
    fmt::print("device cuda  {}, built with {}, driver {} serves {}\n", counted(report.gpus.size(), "GPU"), cuda_version(report.runtime_version),
               report.driver_version.empty() ? "of unknown version" : report.driver_version, cuda_version(report.driver_supports));
    for (std::size_t i = 0; i < report.gpus.size(); ++i) {
        const Gpu& gpu = report.gpus[i];
        const std::string state = gpu.problem.empty() ? bytes_text(static_cast<double>(gpu.free_bytes)) + " free" : "cannot be used: " + gpu.problem;
        fmt::print("  gpu {:<12} {}, compute capability {}.{}, {}, {}\n", i, gpu.name, gpu.major, gpu.minor, bytes_text(static_cast<double>(gpu.total_bytes)), state);
    }
    if (report.gpus.size() > 1) fmt::print("  gpu 0 is the one that runs; CUDA_VISIBLE_DEVICES chooses another\n");
}

int info(bool schema) {
    if (schema) {
        fmt::print("{}", schema_text());
        return done;
    }
    fmt::print("grainray     {}\n", GRAINRAY_VERSION);
    fmt::print("device cpu   {} threads, {}, {}\n", ThreadLimit::count(), vector_level(), bytes_text(machine_memory_bytes()));
    print_backends(Device::cpu);
    print_gpus();
    print_backends(Device::cuda);
    fmt::print("runs         on {}\n", cuda_available() ? "cuda (--device cpu for the CPU)" : "cpu");
    print_libraries();
    return done;
}

}  // namespace

void add_info(CLI::App& app, Action& chosen) {
    Command command(app, chosen, "info", "Devices, search back ends and why others are not there");
    const auto schema = std::make_shared<bool>(false);
    command.flag("--schema", *schema, "Print every key of a scene file: type, unit, default, meaning");
    command.footer("Example: grainray info --schema | less");
    command.action([schema] { return info(*schema); });
}

}  // namespace grainray::cli
