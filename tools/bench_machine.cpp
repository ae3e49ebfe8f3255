// Names of the hardware, for files of figures.
#include <fstream>
#include <regex>

#include "bench_contest.hpp"

namespace grainray::cli {
namespace {

std::string first_match(const char* file, const std::regex& pattern) {
    std::ifstream in(file);
    std::smatch match;
    for (std::string line; std::getline(in, line);)
        if (std::regex_search(line, match, pattern)) return match[1];
    return "not known";
}

std::string processor() { return first_match("/proc/cpuinfo", std::regex("^model name\\s*:\\s*(.*)$")); }

}  // namespace

nlohmann::ordered_json machine_json(Device device, const std::string& name, int threads) {
    nlohmann::ordered_json machine;
    const std::string gpu = cuda_available() ? cuda_report().gpus.at(0).name : "none";
    machine["name"] = !name.empty() ? name : device == Device::cuda ? gpu : processor();
    machine["device"] = std::string(grainray::name(device));
    machine["cpu"] = processor();
    machine["threads"] = threads;
    machine["gpu"] = gpu;
    if (cuda_available()) machine["driver"] = cuda_report().driver_version;
    for (const BackendInfo& info : search_backends(device)) machine["backends"][info.name] = info.reason;
    return machine;
}

}  // namespace grainray::cli
