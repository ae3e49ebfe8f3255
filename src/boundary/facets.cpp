// Stages: surfaces of triangles. Candidates when lists are made; forces in a stage of its own that touches only the
// particles near a facet and adds to State::wrench, so that it may run before or after any other force.
#include "boundary/facet_contact.hpp"
#include "contacts/laws.hpp"
#include "exec/exec.hpp"
#include "stages.hpp"

namespace grainray::GRAINRAY_EXEC {
namespace {

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
    double fine, unit, dt, steps;

    template <class Visit>
    GR_HD void for_each(std::size_t i, const Visit& visit) const {
        const Vec3d x = convert<double>(join(near[i], far[i])) * fine;
        const double own = (static_cast<double>(length(frame[i])) * steps + 2.0 * built[i].radius) * unit +  // 2: trigger "published"
                           static_cast<double>(length(body[i].velocity)) * dt;
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
            p.scale.fine(), p.scale.unit, constants.dt, static_cast<double>(s.age.limit)};
}

/// Numbers the particles that have candidates and returns how many there are; counts[i] is the length of row i.
std::size_t number_rows(View<const std::uint64_t> counts, View<std::uint64_t> row) {
    for_each(row.size, [=] GR_HD(std::size_t i) { row[i] = i < counts.size && counts[i] > 0; });
    return exclusive_scan(row);
}

}  // namespace

void facet_candidates(State& s, const StepConstants& constants) {
    FacetList& list = s.facets.list;
    list.particles.swap(s.facets.old_list.particles);
    list.offsets.swap(s.facets.old_list.offsets);
    list.facets.swap(s.facets.old_list.facets);
    list.states.swap(s.facets.old_list.states);
    const NearFacets near = near_facets(s, constants);
    const std::size_t n = s.facets.count() ? s.size() : 0;
    Array<std::uint64_t> counts_of(device, n), row_of(device, n + 1);
    const auto counts = counts_of.view(), row = row_of.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        std::uint64_t count = 0;
        near.for_each(i, [&](std::uint32_t) { ++count; });
        counts[i] = count;
    }, 256);
    const std::size_t rows = number_rows(counts, row);
    list.particles.resize_discard_slack(rows);
    list.offsets.resize_discard_slack(rows + 1);
    list.offsets.clear_bytes();
    const auto particles = list.particles.view();
    const auto offsets = list.offsets.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        if (counts[i] == 0) return;
        particles[row[i]] = static_cast<std::uint32_t>(i);
        offsets[row[i]] = counts[i];
    });
    list.facets.resize_discard_slack(exclusive_scan(offsets));
    list.states.resize_discard_slack(list.facets.size());
    list.shares.resize_discard_slack(list.facets.size());
    const auto facets = list.facets.view();
    for_each(rows, [=] GR_HD(std::size_t k) {
        std::uint64_t slot = offsets[k];
        near.for_each(particles[k], [&](std::uint32_t facet) { facets[slot++] = facet; });
        sort_row(facets.data + offsets[k], slot - offsets[k]);
    }, 64);
}

void carry_facets(State& s, const Array<std::uint32_t>& old_index) {
    const FacetList &old = s.facets.old_list, &list = s.facets.list;
    constexpr std::uint32_t none = ~0u;
    Array<std::uint32_t> old_row_of(device, s.size());
    const auto old_row = old_row_of.view();
    for_each(s.size(), [=] GR_HD(std::size_t i) { old_row[i] = none; });
    const auto old_particles = old.particles.view();
    for_each(old.rows(), [=] GR_HD(std::size_t k) { old_row[old_particles[k]] = static_cast<std::uint32_t>(k); });

    const auto particles = list.particles.view(), was = old_index.view();
    const auto offsets = list.offsets.view(), old_offsets = old.offsets.view();
    const auto facets = list.facets.view(), old_facets = old.facets.view();
    const auto old_states = old.states.view();
    const auto states = s.facets.list.states.view();
    for_each(list.rows(), [=] GR_HD(std::size_t k) {
        const std::uint32_t r = old_row[was[particles[k]]];
        std::uint64_t o = r == none ? 0 : old_offsets[r];
        const std::uint64_t end = r == none ? 0 : old_offsets[r + 1];
        for (std::uint64_t e = offsets[k]; e < offsets[k + 1]; ++e) {  // both rows ascend
            while (o < end && old_facets[o] < facets[e]) ++o;
            states[e] = o < end && old_facets[o] == facets[e] ? old_states[o] : FacetState{};
        }
    }, 256);
}

namespace {

struct Add {
    GR_HD std::size_t operator()(std::size_t a, std::size_t b) const { return a + b; }
};

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
    View<std::uint64_t> crossed;
    double fine, unit, dt, inverse_force, inverse_torque;

    GR_HD void operator()(std::size_t k) const {
        const std::uint32_t i = particles[k];
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
            if (f.touching) add(wrench[i], convert<float>(f.force), convert<float>(f.torque));
            if (f.crossed) atomic_min(&crossed[0], static_cast<std::uint64_t>(id[i]) << 32 | q);
            e = last;
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

std::size_t count_lost(const State& s, const LostRegion& region) {
    const auto near = s.particles.near.view();
    const auto far = s.particles.far.view();
    const double fine = s.particles.scale.fine(), unit = s.particles.scale.unit;
    return reduce(s.size(), std::size_t{0}, [=] GR_HD(std::size_t i) -> std::size_t {
        return region.lost(convert<double>(join(near[i], far[i])) * fine, near[i].radius * unit);
    }, Add{});
}

void facets(State& s, ContactLaw law, const StepConstants& constants, std::uint32_t step) {
    Facets& f = s.facets;
    const std::size_t surfaces = f.count();
    const Particles& p = s.particles;
    const View<const SurfaceNow> now{f.now.data() + step * surfaces, surfaces};
    with_law(law, constants.dt, [&](auto functor) {
        for_each(f.list.rows(), FacetForces<decltype(functor)>{
            functor, shapes_of(f), now, f.parameters.view(), f.list.particles.view(), f.list.offsets.view(), f.list.facets.view(),
            f.list.states.view(), f.list.shares.view(), p.near.view(), p.far.view(), p.body.view(), p.id.view(), s.wrench.view(),
            f.crossed.view(), p.scale.fine(), p.scale.unit, constants.dt, 1.0 / s.quanta.force, 1.0 / s.quanta.torque}, 64);
    });
}

}  // namespace grainray::GRAINRAY_EXEC
