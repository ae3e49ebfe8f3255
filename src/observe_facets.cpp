// Contacts with meshes and terrain, and what belongs to them in a checkpoint.
#include <algorithm>

#include "boundary/facet_contact.hpp"
#include "observe.hpp"

namespace grainray {

FacetSnapshot::FacetSnapshot(const Facets& f)
    : surfaces(f.surfaces.to_host()), triangles(f.triangles.to_host()), cell_offsets(f.cell_offsets.to_host()), cell_triangles(f.cell_triangles.to_host()),
      heights(f.heights.to_host()), now(f.now.to_host()), parameters(f.parameters.to_host()), particles(f.list.particles.to_host()),
      offsets(f.list.offsets.to_host()), facets(f.list.facets.to_host()), states(f.list.states.to_host()) {}

FacetShapes FacetSnapshot::shapes() const {
    const auto view = []<class T>(const std::vector<T>& v) { return View<const T>{v.data(), v.size()}; };
    return {view(surfaces), view(triangles), view(cell_offsets), view(cell_triangles), view(heights)};
}

namespace {

template <class Law>
void visit_facets(const Snapshot& s, const Law& law, const std::function<void(const FacetTouch&)>& visit) {
    const FacetSnapshot& f = s.facets;
    const FacetShapes shapes = f.shapes();
    const auto count = static_cast<std::uint32_t>(f.surfaces.size());
    std::vector<FacetState> states = f.states;
    std::vector<float> shares(states.size());
    for (std::size_t k = 0; k < f.particles.size(); ++k) {
        const std::uint32_t i = f.particles[k];
        const FacetParticle particle{s.scale.local(join(s.near[i], s.far[i])), s.radius(i), s.body[i]};
        for (std::uint64_t e = f.offsets[k], last; e < f.offsets[k + 1]; e = last) {
            const std::uint32_t q = shapes.surface_of(f.facets[e], 0);
            const Surface& surface = f.surfaces[q];
            for (last = e + 1; last < f.offsets[k + 1] && f.facets[last] < surface.first + surface.count;) ++last;
            const FacetEntries entries{&f.facets[e], &states[e], &shares[e], static_cast<std::uint32_t>(last - e)};
            const FacetForce force = FacetContact<Law>{law, shapes, surface, f.now[q], f.parameters[particle.body.material * count + q], particle, entries, 0}();
            if (!force.touching) continue;
            const Vec3d torque_on_surface = -(cross(particle.position - f.now[q].centre, force.force) + force.torque);
            visit({i, q, force.overlap, convert<float>(force.force), -force.force, torque_on_surface});
        }
    }
}

}  // namespace

void Snapshot::for_each_facet_contact(const std::function<void(const FacetTouch&)>& visit) const {
    if (facets.surfaces.empty() || size() == 0) return;
    with_law(law, 0.0f, [&](const auto& still) { visit_facets(*this, still, visit); });
}

void Snapshot::for_each_facet_memory(const std::function<void(std::uint32_t i, std::uint32_t facet, const FacetState&)>& visit) const {
    for (std::size_t k = 0; k < facets.particles.size(); ++k)
        for (std::uint64_t e = facets.offsets[k]; e < facets.offsets[k + 1]; ++e)
            if (facets.states[e].side != 0) visit(facets.particles[k], facets.facets[e], facets.states[e]);
}

void add_facets(const Snapshot& snap, Checkpoint& c) {
    struct Entry {
        std::uint32_t id, facet;
        FacetState state;
    };
    std::vector<Entry> entries;
    snap.for_each_facet_memory([&](std::uint32_t i, std::uint32_t facet, const FacetState& state) { entries.push_back({snap.id[i], facet, state}); });
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.id != b.id ? a.id < b.id : a.facet < b.facet; });
    for (const Entry& e : entries) {
        c.facet_particle.push_back(e.id);
        c.facet.push_back(e.facet);
        c.facet_side.push_back(e.state.side);
        c.facet_history.push_back(e.state.history);
    }
}

void restore_facets(const Checkpoint& c, FacetList& list) {
    std::vector<std::uint32_t> particles;
    std::vector<std::uint64_t> offsets;
    std::vector<FacetState> states;
    std::size_t place = 0;
    for (std::size_t k = 0; k < c.facet.size(); ++k) {
        while (c.id.at(place) != c.facet_particle[k]) ++place;
        if (particles.empty() || particles.back() != place) {
            particles.push_back(static_cast<std::uint32_t>(place));
            offsets.push_back(k);
        }
        states.push_back({c.facet_history[k], c.facet_side[k]});
    }
    offsets.push_back(c.facet.size());
    std::vector<std::uint32_t> row_of(c.id.size(), ~0u);
    for (std::size_t k = 0; k < particles.size(); ++k) row_of[particles[k]] = static_cast<std::uint32_t>(k);
    list.row_of.assign(row_of);
    list.particles.assign(particles);
    list.offsets.assign(offsets);
    list.facets.assign(c.facet);
    list.states.assign(states);
}

}  // namespace grainray
