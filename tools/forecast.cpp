#include "forecast.hpp"

#include <algorithm>
#include <cmath>

namespace grainray::cli {
namespace {

// Measured on the CPU with column collapses of 20,160 and 161,280 grains that lie on each other (15 neighbours in the
// list of a grain; 710 and 570 bytes) and with two spheres, bytes a particle.
constexpr double state_bytes = 800;
constexpr double peak_bytes = 2500;    // while a frame or a checkpoint is written; 2300 found
constexpr double process_bytes = 90e6;  // of the program itself
// A vtp frame with every field holds 72 bytes in base64 and its tags; as text a value takes about 9.
constexpr double vtp_bytes = 118, csv_bytes = 180, file_bytes = 2000;
constexpr double checkpoint_bytes = 130;

}  // namespace

std::vector<double> expected_counts(const Scene& scene) {
    std::vector<double> counts;
    for (const ParticleGroup& group : scene.particles) {
        double count = 0;
        if (const auto* lattice = std::get_if<Lattice>(&group.placement))
            count = static_cast<double>(lattice->count[0]) * static_cast<double>(lattice->count[1]) * static_cast<double>(lattice->count[2]);
        else if (const auto* list = std::get_if<ParticleList>(&group.placement)) count = static_cast<double>(list->positions.size());
        else if (const auto* fill = std::get_if<RandomFill>(&group.placement)) count = static_cast<double>(fill->count);
        counts.push_back(count);
    }
    return counts;
}

Forecast forecast(const Scene& scene, double particles, std::uint64_t steps) {
    Forecast f;
    f.memory_bytes = state_bytes * particles;
    f.peak_bytes = process_bytes + peak_bytes * particles;
    f.frame_bytes = particles * (scene.output.format == "csv" ? csv_bytes : vtp_bytes) + file_bytes;
    const double frames = scene.output.frames > 0 ? std::floor(static_cast<double>(steps) * scene.dt / std::max(scene.output.frames, scene.dt)) + 1 : 2;
    f.disk_bytes = frames * f.frame_bytes + 2 * checkpoint_bytes * particles;  // the old checkpoint goes when the new one is there
    return f;
}

}  // namespace grainray::cli
