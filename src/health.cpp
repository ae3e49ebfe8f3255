// The exact state of a run: checkpoint, hash, and whether it still makes sense.
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cstdio>
#include <limits>

#include "exec/cpu.hpp"
#include "mix.hpp"
#include "observe.hpp"

namespace grainray {
namespace {

/// The axis along which a centre is outside the domain (0, 1, 2), or -1; periodic axes have no outside.
int axis_left(const Domain& domain, const Vec3d& x) {
    for (int a = 0; domain.box && a < 3; ++a)
        if (!domain.periodic[a] && !(x[a] >= domain.box->lower[a] && x[a] <= domain.box->upper[a])) return a;
    return -1;
}

/// Whatever leaves the domain is taken out.
bool has_outside(const Scene& scene) {
    return std::any_of(scene.removals.begin(), scene.removals.end(), [](const Removal& r) { return r.region == RemovalRegion::outside; });
}

/// The domain as a limit; none where its outside is emptied.
Domain limit_of(const Scene& scene) {
    Domain domain = scene.domain;
    if (has_outside(scene)) domain.box.reset();
    return domain;
}

/// The lower (side -1) or upper (side 1) corner; infinite where nothing can be left.
Vec3d domain_corner(const Domain& domain, int side) {
    Vec3d corner;
    for (int a = 0; a < 3; ++a)
        corner[a] = domain.box && !domain.periodic[a] ? (side < 0 ? domain.box->lower : domain.box->upper)[a] : side * std::numeric_limits<double>::infinity();
    return corner;
}

std::string surface_name(const Scene& scene, std::uint32_t surface) {
    return surface < scene.meshes.size() ? "mesh '" + scene.meshes[surface].name + "'" : "the terrain";
}

template <class... Arguments>
std::string format(const char* text, Arguments... arguments) {
    char buffer[512];
    std::snprintf(buffer, sizeof buffer, text, arguments...);
    return buffer;
}

}  // namespace

Checkpoint Simulation::checkpoint() const {
    const Snapshot snap(impl_->state, impl_->law);
    const std::size_t n = snap.size();
    Checkpoint c;
    c.step = impl_->step_number;
    c.time = impl_->time();
    c.dt = impl_->scene.dt;
    c.unit = snap.scale.unit;
    c.origin = snap.scale.origin;
    c.largest_radius = impl_->largest_radius;
    c.scene = impl_->scene.source;
    c.state_hash = state_hash();
    impl_->keep_exchanges(c);
    const std::vector<std::uint32_t> order = places_by_id(snap.id);
    c.id.resize(n);
    c.material.resize(n);
    c.position.resize(n);
    c.radius.resize(n);
    c.mass.resize(n);
    c.radius_units.resize(n);
    for (auto* v : {&c.velocity, &c.velocity_remainder, &c.angular_velocity}) v->resize(n);
    cpu::for_each(n, [&](std::size_t k) {
        const std::uint32_t i = order[k];
        c.id[k] = snap.id[i];
        c.material[k] = snap.body[i].material;
        c.position[k] = snap.position(i);
        c.radius[k] = static_cast<float>(snap.radius(i));
        c.mass[k] = snap.body[i].mass;
        c.radius_units[k] = snap.near[i].radius;
        c.velocity[k] = snap.body[i].velocity;
        c.velocity_remainder[k] = snap.remainder[i];
        c.angular_velocity[k] = snap.body[i].spin;
    });
    struct Entry {
        std::uint32_t a, b;
        Vec3f h;
    };
    std::vector<Entry> pairs, walls;
    snap.for_each_history([&](std::uint32_t i, std::uint32_t j, bool wall, const Vec3f& history) {
        if (history == Vec3f{}) return;
        const std::uint32_t a = snap.id[i];
        if (wall) walls.push_back({a, j, history});
        else if (const std::uint32_t b = snap.id[j]; a > b) pairs.push_back({a, b, history});
        else pairs.push_back({b, a, -history});
    });
    const auto before = [](const Entry& x, const Entry& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; };
    add_facets(snap, c);
    tbb::parallel_sort(pairs, before);
    tbb::parallel_sort(walls, before);
    for (const Entry& e : pairs) {
        c.contact_a.push_back(e.a);
        c.contact_b.push_back(e.b);
        c.contact_history.push_back(e.h);
    }
    for (const Entry& e : walls) {
        c.wall_particle.push_back(e.a);
        c.wall_plane.push_back(e.b);
        c.wall_history.push_back(e.h);
    }
    return c;
}

std::uint64_t Simulation::state_hash() const {
    const Impl& s = *impl_;
    const std::uint64_t time = mix(0, s.step_number) + s.hash_exchanges();
    if (s.state.size() == 0) return time;
    return time + s.stage.hash(s.state) + (s.state.facets.count() ? s.stage.hash_facets(s.state) : 0);
}

void Simulation::check_health() const {
    const Impl& s = *impl_;
    if (s.state.size() == 0) return;
    const Domain domain = limit_of(s.scene);
    const double speed_limit = s.scene.limits.speed > 0 ? s.scene.limits.speed : s.smallest_radius / s.scene.dt;
    const auto flags = s.state.flags.to_host();
    const bool every_step_finite = s.rebuilds == 0 || flags[1] == ~0u;
    const std::uint64_t crossed = s.state.facets.count() ? s.state.facets.crossed.to_host()[0] : ~0ull;
    bool surfaces_hold = crossed == ~0ull;
    for (std::uint32_t q = 0; q < s.state.facets.count(); ++q)
        surfaces_hold = surfaces_hold && s.stage.surface_totals(s.state, s.law, q).max_overlap_ratio <= s.scene.limits.overlap;
    if (every_step_finite && surfaces_hold && s.stage.healthy(s.state, {speed_limit, s.scene.limits.overlap, domain_corner(domain, -1), domain_corner(domain, 1)})) return;
    const Snapshot snap(s.state, s.law);
    const std::size_t n = snap.size();

    std::size_t worst = n;
    std::string what;
    std::string remedy = s.critical_dt > 0 && s.scene.dt > s.critical_dt
                             ? "Lower simulation.dt"
                             : "Look for particles placed inside each other, or lower simulation.dt or the stiffness";
    if (!every_step_finite) {
        worst = flags[1];
        what = "the step of";
    }
    for (std::size_t i = 0; i < n && worst == n; ++i) {
        const double speed = length(convert<double>(snap.body[i].velocity)), spin = length(convert<double>(snap.body[i].spin));
        const int axis = axis_left(domain, snap.scale.world(snap.position(i)));
        if (std::isfinite(speed) && std::isfinite(spin) && speed <= speed_limit && axis < 0) continue;
        worst = i;
        if (axis >= 0) {
            what = format("the domain was left along %c (domain.lower, domain.upper) by", "xyz"[axis]);
            remedy = "Enlarge the domain or close it with planes";
        } else what = speed > speed_limit ? format("speed %.6g m/s, past the limit of %.6g m/s (limits.speed), of", speed, speed_limit)
                                   : std::string("a velocity or spin that is not finite, of");
    }
    std::string neighbors;
    int named = 0;
    snap.for_each_contact([&](const TouchingContact& c) {
        const double ratio = c.overlap / (c.wall ? snap.radius(c.i) : std::min(snap.radius(c.i), snap.radius(c.j)));
        if (worst == n && ratio > s.scene.limits.overlap) {
            worst = c.i;
            what = format("overlap of %.4g of the smaller radius, past the limit of %.4g (limits.overlap), of", ratio, s.scene.limits.overlap);
        }
    });
    snap.for_each_facet_contact([&](const FacetTouch& c) {
        const double ratio = c.overlap / snap.radius(c.i);
        if (worst == n && ratio > s.scene.limits.overlap) {
            worst = c.i;
            what = format("overlap of %.4g of the radius, past the limit of %.4g (limits.overlap), with ", ratio, s.scene.limits.overlap) +
                   surface_name(s.scene, c.surface) + " of";
        }
    });
    if (worst == n && crossed != ~0ull) {
        worst = static_cast<std::size_t>(std::find(snap.id.begin(), snap.id.end(), crossed >> 32) - snap.id.begin());
        what = "went through " + surface_name(s.scene, static_cast<std::uint32_t>(crossed)) + ":";
        remedy = "A particle must move less than its diameter in a step, and a contact holds until its overlap is the diameter: lower simulation.dt or "
                 "raise the stiffness";
    }
    if (worst == n) return;
    snap.for_each_facet_contact([&](const FacetTouch& c) {
        if (named < 4 && c.i == worst) neighbors += (named++ ? ", " : "") + surface_name(s.scene, c.surface) + format(" (overlap %.4g m)", c.overlap);
    });
    snap.for_each_contact([&](const TouchingContact& c) {
        if (named == 4 || (c.i != worst && (c.wall || c.j != worst))) return;
        const std::string other = c.wall ? "plane '" + s.scene.planes[c.j].name + "'" : "particle " + std::to_string(snap.id[c.i == worst ? c.j : c.i]);
        neighbors += (named++ ? ", " : "") + other + format(" (overlap %.4g m)", c.overlap);
    });
    const Vec3d x = snap.scale.world(snap.position(worst));
    const Body& b = snap.body[worst];
    throw SimulationError(
        format("stopped at t = %.6g s (step %llu): ", s.time(), static_cast<unsigned long long>(s.step_number)) + what +
        format(" particle %u at (%.6g, %.6g, %.6g) m, radius %.4g m, velocity (%.4g, %.4g, %.4g) m/s", snap.id[worst], x.x, x.y, x.z,
               snap.radius(worst), b.velocity.x, b.velocity.y, b.velocity.z) +
        "; touching: " + (neighbors.empty() ? "nothing" : neighbors) +
        format("; dt = %.3g s, critical dt = %.3g s. ", s.scene.dt, s.critical_dt) +
        remedy);
}

}  // namespace grainray
