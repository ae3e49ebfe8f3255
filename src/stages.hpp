// The stage functions of each executor. Those of stages.inc are compiled once for each from one source.
#pragma once

#include "insertion/exchange.hpp"
#include "measures.hpp"

namespace grainray {

/// The stages, one table an executor; simulation.cpp calls them in the order of its step().
struct Stages {
    /// What the list knows of touching pairs, row after row; the list may be made anew.
    void (*retire)(State&, ContactList& old_list);
    /// Morton order where the last has aged, periodic wrap; returns the old index of every new one: its row in the old lists. rows: where that row is
    /// not the index before sorting, because particles came or went; else empty.
    void (*sort)(State&, const ContactList& old_list, const Array<std::uint32_t>& rows, Array<std::uint32_t>& old_index);
    /// Frames, margins, positions of this build, ListAge::limit; clears State::flags; `spheres` gets 4 floats a particle: x y z reach.
    /// Returns what is true of them.
    Extents (*margins)(State&, const StepConstants&, const MarginRule&, Array<float>& spheres);
    /// The pairs found become the list, with the histories of the old one; sign -1 where the pair stood in the other row.
    void (*list_pairs)(State&, NeighborList& found, const ContactList& old_list, const Array<std::uint32_t>& old_index);
    /// Planes within reach of each particle until the list's limit, with the histories of the old list.
    void (*list_walls)(State&, const StepConstants&, const ContactList& old_list, const Array<std::uint32_t>& old_index);

    void (*contacts)(State&, ContactLaw, const StepConstants&);
    void (*walls)(State&, ContactLaw, const StepConstants&);
    /// Moves every particle; sets State::flags.
    void (*integrate)(State&, const StepConstants&, float trigger);
    /// Instead of the three above, where it is cheaper: up to `steps` steps without the host. Returns the steps done;
    /// they end early where the list is used up. Null: step by step.
    std::uint32_t (*fused)(State&, ContactLaw, const StepConstants&, float trigger, std::uint32_t steps);

    /// Who has moved farthest for its margin since the list was made.
    Leaver (*list_end)(const State&, const StepConstants&);

    /// The pairs that touch now, row after row in the order of the list's rows.
    void (*touching)(const State&, ContactList& out);
    ListFigures (*list_figures)(const State&);
    Totals (*totals)(const State&, const Vec3d& gravity);
    /// x of the particle that has this share of all particles behind it, m.
    double (*quantile_x)(const State&, double quantile);
    /// 64 bits over everything that the next step depends on, but the lists.
    std::uint64_t (*hash)(const State&);
    bool (*healthy)(const State&, const HealthLimits&);
    void (*contact_fields)(const State&, ContactLaw, ContactFields& out);

    /// Meshes and terrain: rows of facets within reach of a particle until the list's limit, with what the old rows remember.
    void (*list_facets)(State&, const StepConstants&, const Array<std::uint32_t>& old_index);
    /// Their forces, of the particles that have a row, before those steps that use them. step: of a batch, and row of Facets::now
    /// where surfaces move.
    void (*facets)(State&, ContactLaw, const StepConstants&, std::uint32_t step, FacetTarget);
    SurfaceTotals (*surface_totals)(const State&, ContactLaw, std::uint32_t surface);
    /// What belongs to State's hash.
    std::uint64_t (*hash_facets)(const State&);
    /// Adds to what contact_fields found.
    void (*facet_fields)(const State&, ContactLaw, ContactFields&);

    /// Spheres that reach into a box, images in a periodic domain included.
    std::vector<Resident> (*residents)(const State&, const Box&);
    std::uint64_t (*count_taken)(const State&, const std::vector<Exit>&);
    /// Takes out of the state, but not of its lists, what one of the exits takes. rows: for sort.
    std::vector<Departure> (*take_out)(State&, const std::vector<Exit>&, Array<std::uint32_t>& rows);
};
const Stages& stages(Device);

namespace cpu { extern const Stages stage_table; }
namespace cuda { extern const Stages stage_table; }

}  // namespace grainray

namespace grainray::cpu {
#include "stages.inc"
void contacts(State&, ContactLaw, const StepConstants&);      // contacts/contacts.cpp
void walls(State&, ContactLaw, const StepConstants&);         // boundary/planes.cpp
void integrate(State&, const StepConstants&, float trigger);  // dynamics/integrate.cpp
}  // namespace grainray::cpu
namespace grainray::cuda {
#include "stages.inc"
std::uint32_t fused(State&, ContactLaw, const StepConstants&, float trigger, std::uint32_t steps);  // methods/fused.cu
}  // namespace grainray::cuda
