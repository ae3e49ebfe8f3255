// What a running simulation keeps on its device, and what its stages are told. Stages see nothing else.
#pragma once

#include "boundary/facets.hpp"
#include "contacts/pair.hpp"
#include "grainray/neighbors.hpp"

namespace grainray {

/// What is kept of a pair that touched: one 16-byte read.
struct alignas(16) KeptPair {
    std::uint32_t partner;
    Vec3f history;
};

/// Rows of candidates with the tangential history of each: particle-particle or particle-plane. One row after the other,
/// except the particle pairs of CUDA, which stand in slices (src/exec/rows_cuda.hpp); only those use what is marked so.
struct ContactList {
    explicit ContactList(Device device)
        : offsets(device), counts(device), partners(device), history(device), touched(device), columns(device), spares(device),
          spare_history(device), kept(device) {}
    Array<std::uint64_t> offsets;
    Array<std::uint32_t> counts;       ///< slices: length of each row; of an old list, how many of a row touched
    Array<std::uint32_t> partners;
    Array<Vec3f> history;
    Array<std::uint8_t> touched;       ///< 1 where a history may be other than zero; the CPU's pair loop alone
    Array<std::uint64_t> columns;      ///< slices: first column of histories of each
    Array<std::uint32_t> spares;       ///< slices: spare columns that entries have taken
    Array<Vec3f> spare_history;        ///< slices: the spare columns
    Array<KeptPair> kept;              ///< slices: of an old list, instead of partners and history
    std::uint64_t finished = 0;        ///< slices: steps that ran out of spare columns and were finished with more
    void release() {
        offsets.release();
        counts.release();
        partners.release();
        history.release();
        touched.release();
        columns.release();
        spares.release();
        spare_history.release();
        kept.release();
    }
    std::size_t bytes() const {
        return offsets.bytes() + counts.bytes() + partners.bytes() + history.bytes() + touched.bytes() + columns.bytes() + spares.bytes() +
               spare_history.bytes() + kept.bytes();
    }
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
    double margin = 0;        ///< margins of all particles over their radii
    double widening = 0;      ///< the same of what reaches have beyond the radii: margins and shear
    float widest = 0;         ///< margin that no particle may exceed, units
    double trigger = 1;       ///< how many of its margins a particle may move
};

struct State {
    explicit State(Device device)
        : particles(device), wrench(device), next_near(device), next_far(device), next_body(device), built(device), frame(device),
          grains(device), walls(device), grain_parameters(device), wall_parameters(device), planes(device), facets(device),
          flags(device, 3) {}

    Particles particles;
    Array<Wrench> wrench;   ///< sums of the step under way; the integrator leaves zeros. Not used by the fused step
    Array<Near> next_near;  ///< fused step: what a step writes while others still read `particles`; held during a batch
    Array<Far> next_far;    ///< the same, where an axis is periodic
    Array<Body> next_body;
    Array<Near> built;      ///< position at the last build; `radius` holds the margin, units
    Array<Vec3f> frame;     ///< velocity of the surroundings at the last build, units a step: motion shared is no displacement
    Vec3f lower, upper;     ///< bounds of the centres lately, m from the origin, or the periodic box where there is one
    double disorder = 1e30; ///< ListAge::widening of all lists since particles were put in order
    ContactList grains, walls;
    Array<PairParameters> grain_parameters;  ///< materials x materials
    PairParameters only_parameters{};        ///< the first of them
    Array<PairParameters> wall_parameters;   ///< materials x planes
    Array<PlaneNow> planes; ///< where they are now; of a batch of fused steps with moving planes, one set a step
    std::uint32_t plane_count = 0;
    Facets facets;          ///< meshes and terrain
    Array<std::uint32_t> flags;  ///< [0] a particle past its margin (fused: the step that saw one), [1] one whose step is not finite; ~0: none. [2] fused: spare columns taken
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
    float least = 0;          ///< of the particle's radius
    float spread = 0.5f;      ///< standard deviations of the surroundings' velocity added to the particle's own speed
    float interval = 20;      ///< steps the list is meant to last
    float most_units = 0;     ///< the largest radius: bounds margins
    float trigger = 1;        ///< displacement / margin that outdates the list: 1 safe, 2 published
};

/// The particle that has moved farthest for its margin.
struct Leaver {
    float share = 0;               ///< displacement over margin
    float margin = 0, radius = 0;  ///< units
    float speed = 0;               ///< at which it leaves where it was when the list was made, units a step
};

/// Means over the particles.
struct ListFigures {
    double mean_neighbors = 0;     ///< both sides of a pair counted
    double mean_margin_ratio = 0;  ///< margin / radius
};

}  // namespace grainray
