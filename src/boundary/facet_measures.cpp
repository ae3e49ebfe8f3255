// Stages: what is measured of contacts with meshes and terrain. Nothing here changes the state.
#include "boundary/facet_contact.hpp"
#include "contacts/laws.hpp"
#include "exec/exec.hpp"
#include "mix.hpp"
#include "stages.hpp"

namespace grainray::GRAINRAY_EXEC {
namespace {

struct Scratch {
    Array<FacetState> states{device};  ///< evaluating a contact moves its memory on: this copy's
    Array<float> shares{device};
    explicit Scratch(const FacetList& list) : shares(device, list.facets.size()) { states.assign(list.states); }
};

/// Contacts as the histories stand: the law has a step of 0.
template <class Law>
struct StillContacts {
    Law law;
    FacetShapes shapes;
    View<const SurfaceNow> now;
    View<const PairParameters> parameters;
    View<const std::uint32_t> particles;
    View<const std::uint64_t> offsets;
    View<const std::uint32_t> facets;
    View<FacetState> states;
    View<float> shares;
    View<const Near> near;
    View<const Far> far;
    View<const Body> body;
    double fine, unit;

    StillContacts(const State& s, const Law& still, Scratch& scratch)
        : law(still), shapes(shapes_of(s.facets)), now(s.facets.now.view()), parameters(s.facets.parameters.view()),
          particles(s.facets.list.particles.view()), offsets(s.facets.list.offsets.view()), facets(s.facets.list.facets.view()),
          states(scratch.states.view()), shares(scratch.shares.view()), near(s.particles.near.view()), far(s.particles.far.view()),
          body(s.particles.body.view()), fine(s.particles.scale.fine()), unit(s.particles.scale.unit) {}

    GR_HD FacetParticle particle(std::size_t k) const {
        const std::uint32_t i = particles[k];
        return {convert<double>(join(near[i], far[i])) * fine, near[i].radius * unit, body[i]};
    }
    /// visit(surface, force) for the surfaces that row k touches.
    template <class Visit>
    GR_HD void for_each(std::size_t k, const Visit& visit) const {
        const std::uint32_t count = static_cast<std::uint32_t>(shapes.surfaces.size);
        const FacetParticle p = particle(k);
        for (std::uint64_t e = offsets[k], end = offsets[k + 1]; e < end;) {
            const std::uint32_t q = shapes.surface_of(facets[e], 0);
            const Surface& surface = shapes.surfaces[q];
            std::uint64_t last = e + 1;
            while (last < end && facets[last] < surface.first + surface.count) ++last;
            const FacetEntries entries{facets.data + e, states.data + e, shares.data + e, static_cast<std::uint32_t>(last - e)};
            const FacetForce f = FacetContact<Law>{law, shapes, surface, now[q], parameters[p.body.material * count + q], p, entries, 0}();
            if (f.touching) visit(q, f);
            e = last;
        }
    }
};

struct JoinSurfaceTotals {
    GR_HD SurfaceTotals operator()(SurfaceTotals a, const SurfaceTotals& b) const {
        a.force += b.force;
        a.torque += b.torque;
        a.max_overlap_ratio = fmax(a.max_overlap_ratio, b.max_overlap_ratio);
        a.contacts += b.contacts;
        return a;
    }
};

struct Add {
    GR_HD std::uint64_t operator()(std::uint64_t a, std::uint64_t b) const { return a + b; }
};

template <class Law>
SurfaceTotals totals_of(const StillContacts<Law>& contacts, std::size_t rows, std::uint32_t wanted) {
    return reduce(rows, SurfaceTotals{}, [=] GR_HD(std::size_t k) {
        SurfaceTotals t;
        contacts.for_each(k, [&](std::uint32_t q, const FacetForce& f) {
            if (q != wanted) return;
            const FacetParticle p = contacts.particle(k);
            t.force = -f.force;
            t.torque = -(cross(p.position - contacts.now[q].centre, f.force) + f.torque);
            t.max_overlap_ratio = f.overlap / p.radius;
            t.contacts = 1;
        });
        return t;
    }, JoinSurfaceTotals{});
}

template <class Law>
void add_fields(const StillContacts<Law>& contacts, std::size_t rows, View<std::uint32_t> coordination, View<std::int64_t> force, double inverse_quantum) {
    for_each(rows, [=] GR_HD(std::size_t k) {
        const std::uint32_t i = contacts.particles[k];
        contacts.for_each(k, [&](std::uint32_t, const FacetForce& f) {
            ++coordination[i];
            force[i] += quantize(static_cast<float>(length(f.force)), inverse_quantum);
        });
    }, 64);
}

}  // namespace

SurfaceTotals surface_totals(const State& s, ContactLaw law, std::uint32_t surface) {
    SurfaceTotals out;
    Scratch scratch(s.facets.list);
    with_law(law, 0.0f, [&](auto still) { out = totals_of(StillContacts<decltype(still)>(s, still, scratch), s.facets.list.rows(), surface); });
    return out;
}

void facet_fields(const State& s, ContactLaw law, ContactFields& out) {
    Scratch scratch(s.facets.list);
    with_law(law, 0.0f, [&](auto still) {
        add_fields(StillContacts<decltype(still)>(s, still, scratch), s.facets.list.rows(), out.coordination.view(), out.force.view(), 1.0 / s.quanta.force);
    });
}

std::uint64_t hash_facets(const State& s) {
    const FacetList& list = s.facets.list;
    const auto particles = list.particles.view(), facets = list.facets.view(), id = s.particles.id.view();
    const auto offsets = list.offsets.view();
    const auto states = list.states.view();
    return reduce(list.rows(), std::uint64_t{0}, [=] GR_HD(std::size_t k) {
        std::uint64_t sum = 0;
        for (std::uint64_t e = offsets[k]; e < offsets[k + 1]; ++e)
            if (states[e].side != 0) sum += mix(mix(mix(mix(4, id[particles[k]]), facets[e]), states[e].history), states[e].side > 0 ? 1 : 2);
        return sum;
    }, Add{});
}

}  // namespace grainray::GRAINRAY_EXEC
