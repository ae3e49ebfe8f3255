// A simulation: particles, neighbours, contacts, motion. Nothing here reads or writes files.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "grainray/device.hpp"
#include "grainray/output.hpp"
#include "grainray/scene.hpp"

namespace grainray {

/// Wall-clock seconds each stage of step() took so far. The names are those of the progress line and summary.json.
struct Profile {
    double neighbors = 0;  ///< sort, search, lists, history carry-over
    double contacts = 0;   ///< forces between particles
    double boundary = 0;   ///< forces from planes
    double dynamics = 0;   ///< integration, damping, margin check
    double fused = 0;      ///< on CUDA: contacts, boundary and dynamics, one kernel a step
    double insertion = 0;  ///< streams and removals, new lists included
    double output = 0;     ///< statistics, frames, checkpoints
};

/// What the neighbour search did so far.
struct SearchReport {
    std::string backend, reason;
    std::uint64_t rebuilds = 0;
    double mean_interval_steps = 0;
    double mean_neighbors = 0;  ///< neighbours of a particle in the list, both sides counted
    double mean_margin_ratio = 0;  ///< mean margin / radius at the last rebuild
    std::uint64_t finished_steps = 0;  ///< CUDA: steps with more new contacts than there was room for, finished after making room
};

/// What the particles do to a mesh or the terrain at one instant.
struct SurfaceLoad {
    std::string name;
    Vec3d force;                ///< N
    Vec3d torque;               ///< about the point its motion turns about (the scene's origin without one), N m
    std::uint64_t contacts = 0; ///< particles that touch it
};

/// Whole-system figures at one instant.
struct Statistics {
    std::uint64_t step = 0;
    double time = 0;
    double kinetic_translation = 0, kinetic_rotation = 0;  ///< J
    double potential = 0;                                  ///< -sum m g . (x - world origin), J
    Vec3d momentum;                                        ///< kg m/s
    Vec3d angular_momentum;                                ///< about the world origin, spin included, kg m2/s
    double max_overlap_ratio = 0;                          ///< overlap / smaller radius, contacts with planes included
    double coordination = 0;                               ///< mean touching particles and planes a particle
    double max_speed = 0;                                  ///< m/s
    Vec3d lower, upper;                                    ///< bounds of the sphere surfaces, m
    double front_99 = 0;                                   ///< 99th percentile of the centres' x, m
    double mean_neighbors = 0;
    std::uint64_t contacts = 0;                            ///< touching pairs, planes, meshes and terrain included
    std::vector<SurfaceLoad> surfaces;                     ///< meshes in the order of the scene, then the terrain
};

/// A particle that was taken out: by a removal of the scene, or because it left an open terrain.
struct LostParticle {
    static constexpr std::uint32_t left_terrain = ~0u;
    std::uint64_t step = 0;  ///< after which it was taken out
    double time = 0;         ///< s
    std::uint32_t id = 0;
    Vec3d position;          ///< m
    Vec3f velocity;          ///< m/s
    float radius = 0;        ///< m
    std::uint32_t removal = left_terrain;  ///< number of the removal in the scene
};

/// What a stream has done since it began, restarts included.
struct StreamReport {
    std::string name;
    std::uint64_t inserted = 0;
    std::uint64_t waiting = 0;  ///< due, but without a place so far
    double mass = 0, waiting_mass = 0;  ///< kg
};
/// What a removal has taken out since the run began, restarts included. With an open terrain the last one is what left it.
struct RemovalReport {
    std::string name;
    bool of_terrain = false;
    std::uint64_t particles = 0;
    double mass = 0;  ///< kg
};

struct SimulationOptions {
    Device device = Device::cpu;
    std::string backend = "auto";
    int threads = 0;  ///< 0: all
};

class Simulation {
public:
    /// Throws InputError where the scene cannot be simulated (no particles are allowed: such a run does nothing).
    Simulation(const Scene&, const InitialState&, const SimulationOptions& = {});
    /// Goes on exactly where the checkpoint was taken.
    Simulation(const Scene&, const Checkpoint&, const SimulationOptions& = {});
    ~Simulation();
    Simulation(Simulation&&) noexcept;

    /// One time step: the table of contents of the program (src/simulation.cpp).
    void step();
    void run(std::uint64_t steps);

    std::size_t size() const;
    std::uint64_t step_count() const;
    /// Steps of every particle added up, since this object was made.
    std::uint64_t particle_steps() const;
    double time() const;
    double dt() const;
    Device device() const;

    /// Particles taken out since this object was made or forget_lost() was called, in the order in which they went.
    const std::vector<LostParticle>& lost() const;
    void forget_lost();
    std::vector<StreamReport> streams() const;
    std::vector<RemovalReport> removals() const;

    Statistics statistics() const;
    Frame frame() const;
    Checkpoint checkpoint() const;
    /// 64-bit hash of positions, velocities, spins and contact histories by id; equal on every device and back end.
    std::uint64_t state_hash() const;

    /// Throws SimulationError where a value is not finite or a limit of the scene is passed; names the particle, its
    /// neighbours, overlap, speed and dt against the critical dt.
    void check_health() const;

    const Profile& profile() const;
    Profile& profile();
    SearchReport search() const;
    std::size_t memory_bytes() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// A share of the device memory that a simulation takes, bytes.
struct MemoryPart {
    std::string name;
    double bytes = 0;
};
/// Most device memory that a simulation on CUDA will have held at once, by part; src/device_memory.cpp has the formula.
/// particles: at most; radii: of those that are known; backend: of the search; triangles: of all meshes; nodes: of the terrain.
std::vector<MemoryPart> forecast_device_memory(const Scene&, double particles, const std::vector<double>& radii, const std::string& backend,
                                               double triangles, double nodes);

/// Result of `grainray check`.
struct CriticalStep {
    std::string contact;      ///< "grain-grain normal", "grain-floor tangential", ...
    double critical_dt = 0;   ///< s, of the explicit scheme with its lagged damping
    std::string field;        ///< scene key to change
};
/// The critical time step of every kind of contact in the scene, smallest first; see src/methods/stability.cpp.
std::vector<CriticalStep> critical_steps(const Scene&, const InitialState&);

}  // namespace grainray
