// The inside of a Simulation, for the files that implement it: simulation.cpp (steps), setup.cpp (making and restarting),
// observe.cpp (looking at it).
#pragma once

#include <optional>

#include "exec/threads.hpp"
#include "grainray/simulation.hpp"
#include "neighbors/interval.hpp"
#include "stages.hpp"

namespace grainray {

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
    Array<float> spheres;                    ///< x y z reach, handed to the search

    std::uint64_t step_number = 0;
    std::uint64_t rebuilds = 0, steps_since_start = 0;
    double critical_dt = 0, smallest_radius = 1;
    double largest_radius = 0;               ///< m, of all particles there ever were: it sets the quanta of forces
    bool planes_move = false, meshes_move = false;
    std::optional<LostRegion> region;        ///< of an open terrain
    std::uint64_t lost_every = 0;            ///< steps between two looks for lost particles; 0: none can be lost
    std::vector<LostParticle> lost;
    Profile profile;

    Impl(const Scene&, const SimulationOptions&, const PositionScale&, const InitialState& sizes, double largest_radius = 0);
    void load(const Checkpoint&);            ///< particles, histories and time

    void prepare();                          ///< planes and first lists, so that observers see contacts before any step
    void run(std::uint64_t steps);
    void step();
    std::uint32_t fused_steps(std::uint64_t most);  ///< what step() does, several times, in the device's own time; returns how often
    void update_lists();
    void make_lists();
    void place_planes(std::uint32_t steps = 1);     ///< where they are at time(), and at the steps after it
    void place_meshes(std::uint32_t steps = 1);     ///< the same
    void tune_interval();
    double time_of(std::uint64_t step) const { return static_cast<double>(step) * scene.dt; }
    double time() const { return time_of(step_number); }
};

}  // namespace grainray
