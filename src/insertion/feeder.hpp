// A stream while it runs: what is due, what waits, and where it is put. Its numbers are functions of the seed, its name and
// counters, so that they depend neither on the device nor on threads, and a restart goes on with them.
#pragma once

#include "insertion/inlet.hpp"
#include "insertion/vacancy.hpp"
#include "scene/place.hpp"

namespace grainray {

/// What a checkpoint keeps of a stream.
struct FeederState {
    std::uint64_t key = 0;       ///< of its name
    std::uint64_t since = 0;     ///< step at which its time begins
    std::uint64_t drawn = 0;     ///< particles due so far: numbers 0 ... drawn - 1
    std::uint64_t tried = 0;     ///< numbers below have been looked for a place
    std::uint64_t attempts = 0;  ///< places looked at
    std::uint64_t inserted = 0;
    double drawn_mass = 0, inserted_mass = 0;  ///< kg
    std::vector<std::uint64_t> waiting;        ///< numbers tried that have found no place yet, ascending
};

/// A particle that found a place.
struct Newcomer {
    Vec3l position;  ///< fine units
    double radius;
    Vec3f velocity, spin;
    float mass;
    std::uint32_t material;
};

/// What can be said of a stream before it runs.
struct StreamForecast {
    std::uint64_t interval_steps = 1;  ///< between insertions
    double crossing_time = 0;          ///< s
    double particles = 0, mass = 0;    ///< due until a time, kg
    double fraction = 0;               ///< solid volume of what is due while a particle crosses the inlet over the inlet's volume
};

class Feeder {
public:
    /// Begins at `now`, or later where the stream does. Throws InputError as Inlet.
    Feeder(const Scene&, const ParticleStream&, std::uint64_t now);
    /// Goes on.
    void restore(const FeederState& state) { state_ = state; }

    const ParticleStream& stream() const { return stream_; }
    const FeederState& state() const { return state_; }
    const Inlet& inlet() const { return inlet_; }
    /// The next step after `now` at which it inserts; ~0: never again.
    std::uint64_t next_step(std::uint64_t now) const;
    /// Brings what is due up to date; true where particles look for a place.
    bool draw(std::uint64_t step);
    /// How many insert() looks for a place for: no more than could ever find one at once, so what waits far behind costs nothing.
    std::size_t line_up(const InletRegion&);
    /// Puts as many of them as find a place.
    std::vector<Newcomer> insert(const InletRegion&, Vacancy&, const PositionScale&);
    /// For a run that ends at a step.
    StreamForecast forecast(std::uint64_t last_step) const;

private:
    double mass(std::uint64_t number) const { return particle_mass(radius_(number), density_); }
    double mean_volume() const;
    double elapsed(std::uint64_t step) const;
    /// May one more particle, of this mass, come?
    bool is_due(double elapsed, double mass) const;
    bool over(std::uint64_t step) const;
    bool find_place(const InletRegion&, Vacancy&, const PositionScale&, double radius, Vec3l& place);
    Vec3f velocity(std::uint64_t number) const;

    const Scene& scene_;
    const ParticleStream& stream_;
    Inlet inlet_;
    scene::RadiusSampler radius_;
    scene::Random places_, velocities_;
    std::uint32_t material_ = 0;
    double density_ = 0;
    std::uint64_t interval_ = 1, stop_ = ~std::uint64_t{0};  ///< steps
    FeederState state_;
};

/// Tells streams and removals apart in checkpoints.
std::uint64_t key_of(const std::string& name);

}  // namespace grainray
