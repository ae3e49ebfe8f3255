// Stages: surfaces of triangles. Candidates when lists are made; forces in a stage of its own that touches only the
// particles near a facet and adds to State::wrench, so that it may run before or after any other force.
#include "boundary/facet_contact.hpp"
#include "contacts/laws.hpp"
#include "contacts/old_rows.hpp"
#include "exec/exec.hpp"
#include "exec/overlap.hpp"
#include "stages.hpp"

namespace grainray::GRAINRAY_EXEC {
namespace {

constexpr std::uint32_t no_row = ~0u;

/// Ascending; rows are mostly short, but a boulder on a fine mesh has a long one (Shell 1959, gaps of Ciura).
GR_HD inline void sort_row(std::uint32_t* row, std::size_t size) {
    for (std::size_t gap : {701u, 301u, 132u, 57u, 23u, 10u, 4u, 1u})
        for (std::size_t i = gap; i < size; ++i) {
            const std::uint32_t value = row[i];
            std::size_t j = i;
            for (; j >= gap && row[j - gap] > value; j -= gap) row[j] = row[j - gap];
            row[j] = value;
        }
}

/// Facets that particle i could touch before the list's limit, or touched in the step before: bounds on both motions.
struct NearFacets {
    FacetShapes shapes;
    View<const Near> near;
    View<const Far> far;
    View<const Body> body;
    View<const Near> built;
    View<const Vec3f> frame;
    View<const SurfaceNow> now;
    double fine, unit, dt, steps, trigger;

    template <class Visit>
    GR_HD void for_each(std::size_t i, const Visit& visit) const {
        // About the middle of the way that the surroundings go.
        const Vec3d half = convert<double>(frame[i]) * (0.5 * steps * unit), x = convert<double>(join(near[i], far[i])) * fine + half;
        const double own = length(half) + trigger * built[i].radius * unit + static_cast<double>(length(body[i].velocity)) * dt;
        for (std::uint32_t q = 0; q < shapes.surfaces.size; ++q) {
            const SurfaceNow& s = now[q];
            const double turn = s.reach_spin * (length(x - s.centre) + own);
            const double reach = near[i].radius * unit + (own + (s.reach_speed + turn) * dt * (steps + 1)) * (1 + 1e-9) + unit;
            shapes.for_each_near(q, s.into(x), reach, visit);
        }
    }
};

NearFacets near_facets(const State& s, const StepConstants& constants) {
    const Particles& p = s.particles;
    return {shapes_of(s.facets), p.near.view(), p.far.view(), p.body.view(), s.built.view(), s.frame.view(), s.facets.now.view(),
            p.scale.fine(), p.scale.unit, constants.dt, static_cast<double>(s.age.limit), s.age.trigger};
}

}  // namespace

void list_facets(State& s, const StepConstants& constants, const Array<std::uint32_t>& old_index) {
    std::swap(s.facets.list, s.facets.old_list);
    FacetList& list = s.facets.list;
    const FacetList& old_list = s.facets.old_list;
    const NearFacets near = near_facets(s, constants);
    const std::size_t n = s.size();
    Array<std::uint64_t> counts_of(device, n), numbers(device, n + 1);
    const auto counts = counts_of.view(), number = numbers.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        std::uint64_t count = 0;
        near.for_each(i, [&](std::uint32_t) { ++count; });
        counts[i] = count;
    }, 256);
    for_each(n + 1, [=] GR_HD(std::size_t i) { number[i] = i < n && counts[i] > 0; });
    const std::size_t rows = starts_of_rows(number);

    list.row_of.resize_discard(n);
    list.particles.resize_discard_slack(rows);
    list.forces.resize_discard_slack(rows);
    list.offsets.resize_discard_slack(rows + 1);
    list.offsets.clear_bytes();
    const auto row_of = list.row_of.view(), particles = list.particles.view();
    const auto offsets = list.offsets.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        row_of[i] = counts[i] ? static_cast<std::uint32_t>(number[i]) : no_row;
        if (counts[i] == 0) return;
        particles[number[i]] = static_cast<std::uint32_t>(i);
        offsets[number[i]] = counts[i];
    });
    list.facets.resize_discard_slack(starts_of_rows(offsets));
    list.states.resize_discard_slack(list.facets.size());
    list.shares.resize_discard_slack(list.facets.size());

    const OldIndex was(old_index);
    const auto old_row = old_list.row_of.view();
    const auto facets = list.facets.view();
    const auto old_facets = old_list.facets.view();
    const auto old_offsets = old_list.offsets.view();
    const auto old_states = old_list.states.view();
    const auto states = list.states.view();
    for_each(rows, [=] GR_HD(std::size_t k) {
        std::uint64_t slot = offsets[k];
        near.for_each(particles[k], [&](std::uint32_t facet) { facets[slot++] = facet; });
        sort_row(facets.data + offsets[k], slot - offsets[k]);
        const std::uint32_t r = old_row.size ? old_row[was[particles[k]]] : no_row;
        std::uint64_t o = r == no_row ? 0 : old_offsets[r];
        const std::uint64_t end = r == no_row ? 0 : old_offsets[r + 1];
        for (std::uint64_t e = offsets[k]; e < offsets[k + 1]; ++e) {  // both rows ascend
            while (o < end && old_facets[o] < facets[e]) ++o;
            states[e] = o < end && old_facets[o] == facets[e] ? old_states[o] : FacetState{};
        }
    }, 64);
}

namespace {

constexpr unsigned facet_blocks = 4;  // a multiprocessor: 128 registers a thread

template <class Law>
struct FacetForces {
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
    View<const std::uint32_t> id;
    View<Wrench> wrench;
    View<Wrench> rows;                 ///< forces go here where there are any, else into `wrench`
    View<std::uint64_t> crossed;
    View<const std::uint32_t> flags;
    std::uint32_t step;
    double fine, unit, dt, inverse_force, inverse_torque;

    GR_HD void operator()(std::size_t k) const {
        if (flags[0] < step) return;  // a step of the batch before this one used the list up
        const std::uint32_t i = particles[k];
        Wrench sum{};
        const FacetParticle particle{convert<double>(join(near[i], far[i])) * fine, near[i].radius * unit, body[i]};
        const std::uint32_t surfaces = static_cast<std::uint32_t>(shapes.surfaces.size);
        for (std::uint64_t e = offsets[k], end = offsets[k + 1]; e < end;) {
            const std::uint32_t q = shapes.surface_of(facets[e], 0);
            const Surface& surface = shapes.surfaces[q];
            std::uint64_t last = e + 1;
            while (last < end && facets[last] < surface.first + surface.count) ++last;
            const FacetEntries entries{facets.data + e, states.data + e, shares.data + e, static_cast<std::uint32_t>(last - e)};
            const FacetForce f = FacetContact<Law>{law, shapes, surface, now[q], parameters[particle.body.material * surfaces + q],
                                                   particle, entries, dt}();
            if (f.touching) add(sum, convert<float>(f.force), convert<float>(f.torque));
            if (f.crossed) atomic_min(&crossed[0], static_cast<std::uint64_t>(id[i]) << 32 | q);
            e = last;
        }
        if (rows.size) {
            rows[k] = sum;
            return;
        }
        for (int a = 0; a < 3; ++a) {
            wrench[i].force[a] += sum.force[a];
            wrench[i].torque[a] += sum.torque[a];
        }
    }
    GR_HD void add(Wrench& w, const Vec3f& force, const Vec3f& torque) const {
        for (int a = 0; a < 3; ++a) {
            w.force[a] += quantize(force[a], inverse_force);
            w.torque[a] += quantize(torque[a], inverse_torque);
        }
    }
};

}  // namespace

void facets(State& s, ContactLaw law, const StepConstants& constants, std::uint32_t step, FacetTarget target) {
    Facets& f = s.facets;
    const std::size_t surfaces = f.count();
    const Particles& p = s.particles;
    const View<const SurfaceNow> now{f.now.data() + (f.now.size() > surfaces ? step * surfaces : 0), surfaces};
    const View<Wrench> rows = target == FacetTarget::rows ? f.list.forces.view() : View<Wrench>{};
    with_law(law, constants.dt, [&](auto functor) {
        for_each_first<facet_blocks>(f.list.rows(), FacetForces<decltype(functor)>{
            functor, shapes_of(f), now, f.parameters.view(), f.list.particles.view(), f.list.offsets.view(), f.list.facets.view(),
            f.list.states.view(), f.list.shares.view(), p.near.view(), p.far.view(), p.body.view(), p.id.view(), s.wrench.view(),
            rows, f.crossed.view(), s.flags.view(), step, p.scale.fine(), p.scale.unit, constants.dt, 1.0 / s.quanta.force, 1.0 / s.quanta.torque}, 64);
    });
}

}  // namespace grainray::GRAINRAY_EXEC
