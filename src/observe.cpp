// Looking at a simulation: snapshots, statistics, frames.
#include "observe.hpp"

#include <algorithm>
#include <numeric>

namespace grainray {

Snapshot::Snapshot(const State& s, ContactLaw contact_law)
    : near(s.particles.near.to_host()), far(s.particles.far.to_host()), body(s.particles.body.to_host()), remainder(s.particles.remainder.to_host()),
      id(s.particles.id.to_host()),
      grain_offsets(s.grains.offsets.to_host()), wall_offsets(s.walls.offsets.to_host()), grain_partners(s.grains.partners.to_host()),
      wall_partners(s.walls.partners.to_host()), grain_history(s.grains.history.to_host()), wall_history(s.walls.history.to_host()),
      planes(s.planes.to_host()), facets(s.facets), grain_parameters(s.grain_parameters.to_host()), wall_parameters(s.wall_parameters.to_host()),
      scale(s.particles.scale), period(s.period), period_lower(s.period_lower), block(s.block), materials(s.materials), law(contact_law) {}

Vec3l Snapshot::position(std::size_t i) const {
    Vec3l p = join(near[i], far[i]);
    for (int a = 0; a < 3; ++a) {
        const std::int64_t width = period[a] << fine_bits;
        if (width == 0) continue;
        const std::int64_t r = (p[a] - period_lower[a]) % width;
        p[a] = period_lower[a] + (r < 0 ? r + width : r);
    }
    return p;
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
    const Snapshot snap(s.state, s.law);
    Statistics out;
    out.step = s.step_number;
    out.time = s.time();
    const std::size_t n = snap.size();
    if (n == 0) return out;
    std::vector<double> xs(n);
    out.lower = {1e300, 1e300, 1e300};
    out.upper = -out.lower;
    for (std::size_t i = 0; i < n; ++i) {
        const Body& b = snap.body[i];
        const Vec3d x = snap.scale.world(snap.position(i)), v = convert<double>(b.velocity), w = convert<double>(b.spin);
        const double m = b.mass, r = snap.radius(i), inertia = 0.4 * m * r * r;
        out.kinetic_translation += 0.5 * m * dot(v, v);
        out.kinetic_rotation += 0.5 * inertia * dot(w, w);
        out.potential -= m * dot(s.scene.gravity, x);
        out.momentum += v * m;
        out.angular_momentum += cross(x, v) * m + w * inertia;
        out.max_speed = std::max(out.max_speed, length(v));
        xs[i] = x.x;
        for (int a = 0; a < 3; ++a) {
            out.lower[a] = std::min(out.lower[a], x[a] - r);
            out.upper[a] = std::max(out.upper[a], x[a] + r);
        }
    }
    const auto p99 = xs.begin() + static_cast<std::ptrdiff_t>(std::min(n - 1, static_cast<std::size_t>(0.99 * static_cast<double>(n))));
    std::nth_element(xs.begin(), p99, xs.end());
    out.front_99 = *p99;
    double sides = 0;
    snap.for_each_contact([&](const TouchingContact& c) {
        const double smaller = c.wall ? snap.radius(c.i) : std::min(snap.radius(c.i), snap.radius(c.j));
        out.max_overlap_ratio = std::max(out.max_overlap_ratio, c.overlap / smaller);
        sides += c.wall ? 1 : 2;
        ++out.contacts;
    });
    for (const Mesh& mesh : s.scene.meshes) out.surfaces.push_back({mesh.name, {}, {}, 0});
    if (s.scene.terrain) out.surfaces.push_back({"terrain", {}, {}, 0});
    snap.for_each_facet_contact([&](const FacetTouch& c) {
        out.max_overlap_ratio = std::max(out.max_overlap_ratio, c.overlap / snap.radius(c.i));
        SurfaceLoad& load = out.surfaces[c.surface];
        load.force += c.on_surface;
        load.torque += c.torque;
        ++load.contacts;
        ++sides;
        ++out.contacts;
    });
    out.coordination = sides / static_cast<double>(n);
    out.mean_neighbors = search().mean_neighbors;
    return out;
}

Frame Simulation::frame() const {
    const Snapshot snap(impl_->state, impl_->law);
    const std::size_t n = snap.size();
    Frame f;
    f.step = impl_->step_number;
    f.time = impl_->time();
    std::vector<std::uint32_t> order(n), coordination(n, 0);
    std::vector<float> force(n, 0);
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return snap.id[a] < snap.id[b]; });
    snap.for_each_contact([&](const TouchingContact& c) {
        const float size = length(c.force);
        ++coordination[c.i];
        force[c.i] += size;
        if (!c.wall) {
            ++coordination[c.j];
            force[c.j] += size;
        }
    });
    snap.for_each_facet_contact([&](const FacetTouch& c) {
        ++coordination[c.i];
        force[c.i] += length(c.force);
    });
    for (const std::uint32_t i : order) {
        const Body& b = snap.body[i];
        f.id.push_back(snap.id[i]);
        f.material.push_back(b.material);
        f.coordination.push_back(coordination[i]);
        f.position.push_back(snap.scale.world(snap.position(i)));
        f.radius.push_back(static_cast<float>(snap.radius(i)));
        f.mass.push_back(b.mass);
        f.contact_force.push_back(force[i]);
        f.velocity.push_back(b.velocity);
        f.angular_velocity.push_back(b.spin);
    }
    return f;
}

SearchReport Simulation::search() const {
    const Impl& s = *impl_;
    SearchReport r;
    r.backend = s.search.backend();
    r.reason = s.search.reason();
    r.rebuilds = s.rebuilds;
    if (s.rebuilds) r.mean_interval_steps = static_cast<double>(s.steps_since_start) / static_cast<double>(s.rebuilds);
    const std::size_t n = s.state.size();
    if (n == 0 || s.rebuilds == 0) return r;
    const auto offsets = s.state.grains.offsets.to_host();
    const auto partners = s.state.grains.partners.to_host();
    const auto built = s.state.built.to_host();
    const auto near = s.state.particles.near.to_host();
    for (std::size_t i = 0; i < n; ++i) {
        for (std::uint64_t e = offsets[i]; e < offsets[i + 1]; ++e)
            r.mean_neighbors += i / s.state.block == partners[e] / s.state.block ? 2 : 1;
        r.mean_margin_ratio += static_cast<double>(built[i].radius) / near[i].radius;
    }
    r.mean_neighbors /= static_cast<double>(n);
    r.mean_margin_ratio /= static_cast<double>(n);
    return r;
}

std::size_t Simulation::memory_bytes() const {
    const Impl& s = *impl_;
    const Particles& p = s.state.particles;
    return p.near.bytes() + p.far.bytes() + p.body.bytes() + p.remainder.bytes() + s.state.frame.bytes() + p.id.bytes() + s.state.wrench.bytes() + s.state.built.bytes() +
           s.state.grains.bytes() + s.state.walls.bytes() + s.old_grains.bytes() + s.old_walls.bytes() + s.old_index.bytes() + s.spheres.bytes() + s.search.memory_bytes() + s.state.facets.bytes();
}

}  // namespace grainray
