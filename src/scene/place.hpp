// Pieces of place_particles().
#pragma once

#include <string>
#include <vector>

#include "grainray/scene.hpp"
#include "scene/random.hpp"

namespace grainray::scene {

/// Draws radius number n of a group or stream; the distribution must outlive it. Throws InputError where the cut-offs leave nothing to draw.
class RadiusSampler {
public:
    /// where: begins messages. source: "NAME" of a group, "streams.NAME"; it tells the numbers of each apart.
    RadiusSampler(const SizeDistribution&, std::uint64_t seed, const std::string& source, std::string where);
    double operator()(std::uint64_t n) const;
    double largest() const { return largest_radius(size_); }

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
