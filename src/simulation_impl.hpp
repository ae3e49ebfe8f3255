// The inside of a Simulation, for the files that implement it: simulation.cpp (steps), setup.cpp (making and restarting),
// observe.cpp (looking at it), exchange.cpp (particles that come and go).
#pragma once

#include <chrono>
#include <optional>

#include "exec/threads.hpp"
#include "grainray/simulation.hpp"
#include "insertion/feeder.hpp"
#include "neighbors/interval.hpp"
#include "stages.hpp"

namespace grainray {

/// Adds the time until its end of scope to one entry of the profile.
class Timed {
public:
    explicit Timed(double& seconds) : seconds_(seconds), start_(clock::now()) {}
    ~Timed() { seconds_ += std::chrono::duration<double>(clock::now() - start_).count(); }

private:
    using clock = std::chrono::steady_clock;
    double& seconds_;
    clock::time_point start_;
};

/// A region that takes particles out, and what it has taken.
struct ExitRun {
    Exit exit;
    std::uint64_t every;    ///< steps between two looks
    std::uint32_t removal;  ///< of the scene, or LostParticle::left_terrain
    std::uint64_t key, particles = 0;
    double mass = 0;        ///< kg
};

struct Simulation::Impl {
    Scene scene;
    SimulationOptions options;
    Threads threads;
    State state;
    NeighborSearch search;
    const Stages& stage;

    ContactLaw law;
    StepConstants constants;
    MarginRule margin_rule;
    IntervalTuner tuner;
    Profile list_start;                      ///< the profile when the present list was begun
    ContactList old_grains, old_walls;       ///< what is kept of the lists before the last build
    NeighborList found;                      ///< of the last search
    double usual_life = 1;                   ///< steps that lists lasted lately: fused batches are that long
    Array<std::uint32_t> old_index;
    Array<std::uint32_t> rows;               ///< rows of the old lists, where particles came or went; else empty
    Array<float> spheres;                    ///< x y z reach, handed to the search

    std::uint64_t step_number = 0;
    std::uint64_t rebuilds = 0, steps_since_start = 0, particle_steps = 0;
    double critical_dt = 0, smallest_radius = 1;
    double largest_radius = 0;               ///< m, of all particles there ever were or may come: it sets the quanta of forces
    bool planes_move = false, meshes_move = false;
    std::vector<Feeder> feeders;             ///< of the scene's streams
    std::vector<ExitRun> exits;
    std::vector<LostParticle> lost;
    std::uint64_t placed = 0;                ///< particles at the start of the run
    std::uint64_t next_id = 0;               ///< ids are never used again
    Obstacles obstacles{scene, state};
    Profile profile;

    Impl(const Scene&, const SimulationOptions&, const PositionScale&, const InitialState& sizes, double largest_radius = 0);
    void load(const Checkpoint&);            ///< particles, histories and time

    void prepare();                          ///< planes and first lists, so that observers see contacts before any step
    void run(std::uint64_t steps);
    void step();
    void skip(std::uint64_t steps);
    std::uint32_t fused_steps(std::uint64_t most);  ///< what step() does, several times, in the device's own time; returns how often
    void update_lists();
    void make_lists();
    void find_pairs();                       ///< margins and search
    void release_scratch();                  ///< on CUDA: what only making a list needs
    void place_planes(std::uint32_t steps = 1);     ///< where they are at time(), and at the steps after it
    void place_meshes(std::uint32_t steps = 1);     ///< the same
    void tune_interval();

    void begin_exchanges(const Checkpoint* = nullptr);  ///< streams and removals, from the start or as they were
    void keep_exchanges(Checkpoint&) const;
    std::uint64_t hash_exchanges() const;           ///< what decides on particles to come
    std::uint64_t next_exchange() const;            ///< the step at which particles may come or go
    void exchange();                                ///< what is due at the present step
    std::vector<Departure> depart();
    std::vector<Newcomer> arrive();
    void open_lists();
    void append(const std::vector<Newcomer>&);
    void close_lists();
    void resize_blocks();                           ///< as many as the number of particles asks for
    double time_of(std::uint64_t step) const { return static_cast<double>(step) * scene.dt; }
    double time() const { return time_of(step_number); }
};

}  // namespace grainray
