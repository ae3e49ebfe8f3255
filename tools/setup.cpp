#include "setup.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include "grainray/neighbors.hpp"
#include "resolved_scene.hpp"

namespace grainray::cli {
namespace {

constexpr int most_threads = 1024;

void require_device_name(const std::string& device) { require_choice("--device", device, {"auto", "cpu", "cuda"}); }

}  // namespace

Scene load_resolved(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    Scene scene = load_scene(file, overrides);
    scene.source = resolved_text(scene, overrides);
    return scene;
}

void require_backend(const std::string& option, const std::string& backend, Device device) {
    std::vector<std::string> known{"auto"};
    for (const BackendInfo& info : search_backends(device)) {
        if (info.available) known.push_back(info.name);
        else if (info.name == backend) throw InputError(fmt::format("{}: '{}' is not available on {}: {}", option, backend, name(device), info.reason));
    }
    require_choice(option, backend, known);
}

Device choose_search_device(const std::string& device) {
    require_device_name(device);
    if (device == "cuda" && !cuda_available()) throw InputError("--device cuda: " + cuda_status());
    return device == "cpu" || !cuda_available() ? Device::cpu : Device::cuda;
}

Engine choose_engine(const EngineOptions& asked, const Scene& scene) {
    require_device_name(asked.device);
    Engine engine;
    if (asked.device == "cuda") {
        if (!cuda_available()) throw InputError("--device cuda: " + cuda_status());
        engine.options.device = Device::cuda;
        engine.device_reason = "asked for";
    } else if (asked.device == "cpu") {
        engine.device_reason = "asked for";
    } else if (cuda_available()) {
        engine.options.device = Device::cuda;
        engine.device_reason = cuda_status();
    } else {
        engine.device_reason = cuda_status();
    }
    const bool by_scene = asked.search == "auto" && scene.search.backend != "auto";
    engine.options.backend = by_scene ? scene.search.backend : asked.search;
    require_backend(by_scene ? "search.backend" : "--search", engine.options.backend, engine.options.device);
    if (asked.threads < 0 || asked.threads > most_threads)
        throw InputError(fmt::format("--threads: {} is not a number of threads; give 1 to {}, or 0 for all", asked.threads, most_threads));
    engine.options.threads = asked.threads;
    return engine;
}

struct ThreadLimit::Control {
    tbb::global_control limit;
    explicit Control(int threads) : limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)) {}
};

ThreadLimit::ThreadLimit(int threads) {
    if (threads > 0) control_ = std::make_unique<Control>(threads);
}
ThreadLimit::~ThreadLimit() = default;

int ThreadLimit::count() {
    const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    return static_cast<int>(std::max<std::size_t>(allowed, 1));
}

double peak_resident_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) * 1024;
}

double machine_memory_bytes() {
    const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
    return pages > 0 && size > 0 ? static_cast<double>(pages) * static_cast<double>(size) : 0;
}

}  // namespace grainray::cli
