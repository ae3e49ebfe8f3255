#include "forecast.hpp"

#include <algorithm>
#include <cmath>

namespace grainray::cli {
namespace {

// Measured on the CPU with the settled column of 20,160 grains (14 neighbours in the list of each) and its lattice start,
// bytes a particle; tests/cli checks that runs stay below.
constexpr double state_bytes = 900;
constexpr double peak_bytes_per_particle = 1900;
constexpr double process_bytes = 40e6;
// A vtp frame with every field: 72 bytes in base64; as text a value takes about 9.
constexpr double vtp_bytes = 118, csv_bytes = 180;
constexpr double checkpoint_bytes = 200;

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

Forecast forecast(const Scene& scene, double particles) {
    Forecast f;
    f.memory_bytes = state_bytes * particles;
    f.peak_bytes = process_bytes + peak_bytes_per_particle * particles;
    f.frame_bytes = particles * (scene.output.format == "csv" ? csv_bytes : vtp_bytes);
    const double frames = scene.output.frames > 0 ? std::floor(scene.duration / std::max(scene.output.frames, scene.dt)) + 1 : 2;
    f.disk_bytes = frames * f.frame_bytes + 2 * checkpoint_bytes * particles;  // the old checkpoint goes when the new one is there
    return f;
}

}  // namespace grainray::cli
