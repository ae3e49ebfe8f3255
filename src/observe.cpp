// Looking at a simulation: snapshots, statistics, frames.
#include "observe.hpp"

#include "exec/cpu.hpp"

#include <algorithm>
#include <numeric>

namespace grainray {

Snapshot::Snapshot(const State& s, ContactLaw contact_law)
    : near(s.particles.near.to_host()), far(s.particles.far.to_host()), body(s.particles.body.to_host()), remainder(s.particles.remainder.to_host()),
      id(s.particles.id.to_host()),
      wall_offsets(s.walls.offsets.to_host()), wall_partners(s.walls.partners.to_host()), wall_history(s.walls.history.to_host()),
      planes(s.planes.to_host()), facets(s.facets), grain_parameters(s.grain_parameters.to_host()), wall_parameters(s.wall_parameters.to_host()),
      scale(s.particles.scale), period(s.period), period_lower(s.period_lower), block(s.block), materials(s.materials), law(contact_law) {
    if (s.size() == 0) return;
    ContactList pairs(s.particles.near.device());
    stages(pairs.offsets.device()).touching(s, pairs);
    grain_offsets = pairs.offsets.to_host();
    grain_partners = pairs.partners.to_host();
    grain_history = pairs.history.to_host();
}

Vec3l Snapshot::position(std::size_t i) const { return into_box(join(near[i], far[i]), period, period_lower); }

std::vector<std::uint32_t> places_by_id(const std::vector<std::uint32_t>& id) {
    const std::size_t ids = id.empty() ? 0 : *std::max_element(id.begin(), id.end()) + std::size_t{1};
    std::vector<std::uint32_t> places;
    if (ids > 8 * id.size()) {  // most of those there ever were have gone
        places.resize(id.size());
        std::iota(places.begin(), places.end(), 0u);
        std::sort(places.begin(), places.end(), [&](auto a, auto b) { return id[a] < id[b]; });
        return places;
    }
    places.assign(ids, ~0u);
    for (std::size_t i = 0; i < id.size(); ++i) places[id[i]] = static_cast<std::uint32_t>(i);
    std::erase(places, ~0u);  // of those that have gone
    return places;
}

void Snapshot::for_each_history(const std::function<void(std::uint32_t, std::uint32_t, bool, const Vec3f&)>& visit) const {
    for (std::uint32_t i = 0; i < size(); ++i) {
        for (std::uint64_t e = grain_offsets[i]; e < grain_offsets[i + 1]; ++e) {
            const std::uint32_t j = grain_partners[e];
            if (i / block == j / block || j <= i) visit(i, j, false, grain_history[e]);  // else it stands in both rows
        }
        for (std::uint64_t e = wall_offsets[i]; e < wall_offsets[i + 1]; ++e) {
            const PlaneNow& plane = planes[wall_partners[e]];
            if (radius(i) - dot(plane.normal, scale.local(join(near[i], far[i])) - plane.point) > 0) visit(i, wall_partners[e], true, wall_history[e]);
        }
    }
}

namespace {

/// One pass over the lists; `law` has a step of 0, so that forces are as the histories stand.
template <class Law>
void visit_contacts(const Snapshot& s, const Law& law, const std::function<void(const TouchingContact&)>& visit) {
    const float unit = static_cast<float>(s.scale.unit);
    for (std::uint32_t i = 0; i < s.size(); ++i) {
        const Body& a = s.body[i];
        for (std::uint64_t e = s.grain_offsets[i]; e < s.grain_offsets[i + 1]; ++e) {
            const std::uint32_t j = s.grain_partners[e];
            if (i / s.block != j / s.block && j > i) continue;  // stands in both rows
            const Separation apart = separation(s.near[i], s.far[i], s.near[j], s.far[j], s.period);
            if (apart.gap <= 0) continue;
            const Body& b = s.body[j];
            Vec3f h = s.grain_history[e];
            const PairForce f = pair_force(law, apart, s.near[i].radius, s.near[j].radius, a.velocity - b.velocity, a.spin, b.spin,
                                           0.5f * (a.mass + b.mass), s.grain_parameters[a.material * s.materials + b.material], unit, h);
            const double distance = length(Vec3d{double(apart.x), double(apart.y), double(apart.z)}) * s.scale.unit;
            const double overlap = static_cast<double>(apart.gap) * s.scale.unit * s.scale.unit / (s.radius(i) + s.radius(j) + distance);
            visit({i, j, false, overlap, f.force, s.grain_history[e]});
        }
        for (std::uint64_t e = s.wall_offsets[i]; e < s.wall_offsets[i + 1]; ++e) {
            const std::uint32_t q = s.wall_partners[e];
            const PlaneNow& plane = s.planes[q];
            const Vec3d x = s.scale.local(join(s.near[i], s.far[i]));
            const double overlap = s.radius(i) - dot(plane.normal, x - plane.point);
            if (overlap <= 0) continue;
            const Vec3f n = convert<float>(plane.normal), arm = n * static_cast<float>(s.radius(i) - 0.5 * overlap);
            const Vec3f wall_velocity = plane.velocity + cross(plane.spin, convert<float>(x - plane.centre) - arm);
            Vec3f h = s.wall_history[e];
            const Vec3f force = law(Contact{n, static_cast<float>(overlap), a.velocity - cross(a.spin, arm) - wall_velocity, a.mass},
                                    s.wall_parameters[a.material * s.planes.size() + q], h);
            visit({i, q, true, overlap, force, s.wall_history[e]});
        }
    }
}

}  // namespace

void Snapshot::for_each_contact(const std::function<void(const TouchingContact&)>& visit) const {
    with_law(law, 0.0f, [&](const auto& still) { visit_contacts(*this, still, visit); });
}

Statistics Simulation::statistics() const {
    const Impl& s = *impl_;
    Statistics out;
    out.step = s.step_number;
    out.time = s.time();
    for (const Mesh& mesh : s.scene.meshes) out.surfaces.push_back({mesh.name, {}, {}, 0});
    if (s.scene.terrain) out.surfaces.push_back({"terrain", {}, {}, 0});
    if (s.state.size() == 0) return out;
    const Totals t = s.stage.totals(s.state, s.scene.gravity);
    out.kinetic_translation = t.kinetic_translation;
    out.kinetic_rotation = t.kinetic_rotation;
    out.potential = t.potential;
    out.momentum = t.momentum;
    out.angular_momentum = t.angular_momentum;
    out.max_speed = t.max_speed;
    out.lower = t.lower;
    out.upper = t.upper;
    out.front_99 = s.stage.quantile_x(s.state, 0.99);
    out.max_overlap_ratio = t.max_overlap_ratio;
    out.contacts = t.contacts;
    double sides = t.contact_sides;
    for (std::uint32_t q = 0; q < s.state.facets.count(); ++q) {
        const SurfaceTotals on = s.stage.surface_totals(s.state, s.law, q);
        out.surfaces[q] = {out.surfaces[q].name, on.force, on.torque, on.contacts};
        out.max_overlap_ratio = std::max(out.max_overlap_ratio, on.max_overlap_ratio);
        out.contacts += on.contacts;
        sides += static_cast<double>(on.contacts);
    }
    out.coordination = sides / static_cast<double>(s.state.size());
    out.mean_neighbors = search().mean_neighbors;
    return out;
}

Frame Simulation::frame() const {
    const Impl& s = *impl_;
    const Particles& p = s.state.particles;
    const std::size_t n = s.state.size();
    Frame f;
    f.step = s.step_number;
    f.time = s.time();
    if (n == 0) return f;
    ContactFields fields(s.options.device);
    s.stage.contact_fields(s.state, s.law, fields);
    if (s.state.facets.count()) s.stage.facet_fields(s.state, s.law, fields);
    const auto near = p.near.to_host();
    const auto far = p.far.to_host();
    const auto body = p.body.to_host();
    const auto id = p.id.to_host();
    const auto coordination = fields.coordination.to_host();
    const auto force = fields.force.to_host();
    const std::vector<std::uint32_t> order = places_by_id(id);
    for (auto* v : {&f.id, &f.material, &f.coordination}) v->resize(n);
    for (auto* v : {&f.radius, &f.mass, &f.contact_force}) v->resize(n);
    for (auto* v : {&f.velocity, &f.angular_velocity}) v->resize(n);
    f.position.resize(n);
    cpu::for_each(n, [&](std::size_t k) {
        const std::uint32_t i = order[k];
        f.id[k] = id[i];
        f.material[k] = body[i].material;
        f.coordination[k] = coordination[i];
        f.position[k] = p.scale.world(into_box(join(near[i], far[i]), s.state.period, s.state.period_lower));
        f.radius[k] = static_cast<float>(near[i].radius * p.scale.unit);
        f.mass[k] = body[i].mass;
        f.contact_force[k] = static_cast<float>(static_cast<double>(force[i]) * s.state.quanta.force);
        f.velocity[k] = body[i].velocity;
        f.angular_velocity[k] = body[i].spin;
    });
    return f;
}

SearchReport Simulation::search() const {
    const Impl& s = *impl_;
    SearchReport r;
    r.backend = s.search.backend();
    r.reason = s.search.reason();
    if (const std::string lists = s.tuner.reason(); !lists.empty()) r.reason += "; " + lists;
    r.rebuilds = s.rebuilds;
    r.finished_steps = s.state.grains.finished;
    if (s.rebuilds) r.mean_interval_steps = static_cast<double>(s.steps_since_start) / static_cast<double>(s.rebuilds);
    if (s.state.size() == 0 || s.rebuilds == 0) return r;
    const ListFigures figures = s.stage.list_figures(s.state);
    r.mean_neighbors = figures.mean_neighbors;
    r.mean_margin_ratio = figures.mean_margin_ratio;
    return r;
}

std::size_t Simulation::memory_bytes() const {
    const Impl& s = *impl_;
    const Particles& p = s.state.particles;
    return p.near.bytes() + p.far.bytes() + p.body.bytes() + p.remainder.bytes() + s.state.frame.bytes() + p.id.bytes() + s.state.wrench.bytes() + s.state.built.bytes() +
           s.state.grains.bytes() + s.state.walls.bytes() + s.old_grains.bytes() + s.old_walls.bytes() + s.old_index.bytes() + s.spheres.bytes() + s.search.memory_bytes() + s.state.facets.bytes();
}

}  // namespace grainray
