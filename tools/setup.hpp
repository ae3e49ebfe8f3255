// From options to a scene, a device and a back end: what run, check and bench have in common.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "arguments.hpp"
#include "grainray/simulation.hpp"

namespace grainray::cli {

/// Options of every command that simulates.
struct EngineOptions {
    std::string device = "auto", search = "auto";
    int threads = 0;
    std::vector<std::string> set;
};

/// load_scene with the overrides; `source` is then a text that stands by itself (resolved_scene.hpp).
Scene load_resolved(const std::filesystem::path&, const std::vector<std::string>& overrides);

struct Engine {
    SimulationOptions options;
    std::string device_reason;
};
/// Throws InputError for a device, back end or number of threads that cannot be had.
Engine choose_engine(const EngineOptions&, const Scene&);
/// For `--device auto|cpu|cuda` where the neighbour search alone is asked for.
Device choose_search_device(const std::string& device);
/// Throws InputError for a back end that is not there, `rays` included.
void require_backend(const std::string& option, const std::string& backend, Device);

/// Keeps every part of the program, writers included, within a number of threads (0: no limit) while it lives.
class ThreadLimit {
public:
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    static int count();  ///< threads a parallel loop would use now

private:
    struct Control;
    std::unique_ptr<Control> control_;
};

/// Largest resident size of this process so far, bytes.
double peak_resident_bytes();
/// Memory of this machine, bytes; 0 where it is not known.
double machine_memory_bytes();

}  // namespace grainray::cli
