// Pieces of place_particles().
#pragma once

#include <string>
#include <vector>

#include "grainray/scene.hpp"
#include "scene/random.hpp"

namespace grainray::scene {

/// Draws radius number n of a group. Throws InputError where the cut-offs leave nothing to draw.
class RadiusSampler {
public:
    RadiusSampler(const Scene&, const ParticleGroup&);
    double operator()(std::uint64_t n) const;
    double largest() const;

private:
    double truncated(std::uint64_t n) const;
    double from_table(std::uint64_t n) const;

    const SizeDistribution& size_;
    std::string where_;
    Random random_;
    double log_mean_ = 0, log_deviation_ = 0;
    std::vector<double> cumulative_;
};

/// Appends the particles of one group: positions and radii, and velocities where the placement gives them.
void place_fill(const Scene&, const ParticleGroup&, const RandomFill&, InitialState&);
void place_release(const Scene&, const ParticleGroup&, const Release&, InitialState&);
void place_file(const Scene&, const ParticleGroup&, const ParticleFile&, InitialState&);

/// "scene.toml: key 'particles.NAME.field'", for errors that only placing finds.
std::string place_of(const Scene&, const ParticleGroup&, const std::string& field = "");

}  // namespace grainray::scene
