// What a running simulation keeps on its device, and what its stages are told. Stages see nothing else.
#pragma once

#include "boundary/facets.hpp"
#include "contacts/pair.hpp"
#include "grainray/neighbors.hpp"

namespace grainray {

/// Rows of candidates with the tangential history of each: particle-particle or particle-plane.
struct ContactList {
    explicit ContactList(Device device) : offsets(device), partners(device), history(device) {}
    Array<std::uint64_t> offsets;
    Array<std::uint32_t> partners;
    Array<Vec3f> history;
    std::size_t bytes() const { return offsets.bytes() + partners.bytes() + history.bytes(); }
};

/// A plane at one instant, relative to the world's origin. Distances are taken in double: a plane reaches far.
struct PlaneNow {
    Vec3d point, normal, centre;
    Vec3f velocity, spin;   ///< m/s of `centre`, rad/s about it
    double reach_speed;     ///< bound on the plane's own speed, m/s, plus
    double reach_spin;      ///< bound on |spin|, rad/s
};

/// How old the candidate list is, and how long it may be believed at most.
struct ListAge {
    std::uint32_t steps = 0;  ///< since the build
    std::uint32_t limit = 0;  ///< shear between frames and moving planes are covered for this many steps
    bool outdated = true;
};

struct State {
    explicit State(Device device)
        : particles(device), wrench(device), built(device), frame(device), grains(device), walls(device), grain_parameters(device),
          wall_parameters(device), planes(device), facets(device), flags(device, 2) {}

    Particles particles;
    Array<Wrench> wrench;   ///< sums of the step under way; the integrator leaves zeros
    Array<Near> built;      ///< position at the last build; `radius` holds the margin, units
    Array<Vec3f> frame;     ///< velocity of the surroundings at the last build, units a step: motion shared is no displacement
    Vec3f lower, upper;     ///< bounds of the centres at the last sort, m from the origin
    ContactList grains, walls;
    Array<PairParameters> grain_parameters;  ///< materials x materials
    Array<PairParameters> wall_parameters;   ///< materials x planes
    Array<PlaneNow> planes;
    Facets facets;               ///< meshes and terrain
    Array<std::uint32_t> flags;  ///< [0] a particle past its margin, [1] a particle whose step is not finite; ~0: none
    std::uint32_t materials = 0;
    std::uint32_t block = 1;     ///< of ListKind::blocked
    Quanta quanta;
    Vec3l period;                ///< units; 0 where an axis is not periodic
    Vec3l period_lower;          ///< fine units
    ListAge age;
    std::size_t size() const { return particles.size(); }
};

/// Constants of a run.
struct StepConstants {
    float dt = 0;
    Vec3f gravity;
    float mass_damping = 0;
};

/// How margins are chosen; see src/neighbors/verlet.cpp.
struct MarginRule {
    float least = 0.03f;      ///< of the particle's radius
    float spread = 0.5f;      ///< standard deviations of the surroundings' velocity added to the particle's own speed
    float interval = 20;      ///< steps the list is meant to last
    float most_units = 0;     ///< the largest radius: margins beyond it would outgrow the near words
    float trigger = 1;        ///< displacement / margin that outdates the list: 1 safe, 2 published
};

/// The stages, one table an executor; simulation.cpp calls them in the order of its step().
struct Stages {
    /// Morton order, periodic wrap; returns the old index of every new one.
    void (*sort)(State&, Array<std::uint32_t>& old_index);
    /// Frames, margins, positions of this build, ListAge::limit; `spheres` gets 4 floats a particle: x y z reach.
    void (*margins)(State&, const StepConstants&, const MarginRule&, Array<float>& spheres);
    /// Planes within reach of each particle until the list's limit.
    void (*wall_candidates)(State&, const StepConstants&, ContactList& walls);
    /// Histories of the old list into the new one; sign -1 where the pair stood in the other row.
    void (*carry_pairs)(const ContactList& old_list, const Array<std::uint32_t>& old_index, ContactList& list);
    void (*carry_walls)(const ContactList& old_list, const Array<std::uint32_t>& old_index, ContactList& list);

    void (*contacts)(State&, ContactLaw, const StepConstants&);
    void (*walls)(State&, ContactLaw, const StepConstants&);
    /// Moves every particle; sets State::flags.
    void (*integrate)(State&, const StepConstants&, float trigger);

    /// Meshes and terrain: rows of facets within reach until the list's limit; histories of the old rows into the new.
    void (*facet_candidates)(State&, const StepConstants&);
    void (*carry_facets)(State&, const Array<std::uint32_t>& old_index);
    /// Adds to State::wrench of the particles that have a row. step: row of Facets::now.
    void (*facets)(State&, ContactLaw, const StepConstants&, std::uint32_t step);
    /// Particles that left an open terrain.
    std::size_t (*count_lost)(const State&, const LostRegion&);
};
const Stages& stages(Device);

namespace cpu { extern const Stages stage_table; }
namespace cuda { extern const Stages stage_table; }

}  // namespace grainray
