// Stage: planes. A plane is a half-space: the overlap is r - signed distance, however deep a centre may lie.
#include "contacts/laws.hpp"
#include "exec/exec.hpp"
#include "stages.hpp"

namespace grainray::GRAINRAY_EXEC {
namespace {

struct Centres {
    View<const Near> near;
    View<const Far> far;
    double fine;
    GR_HD Vec3d operator[](std::size_t i) const { return convert<double>(join(near[i], far[i])) * fine; }
};

/// Could plane q touch particle i before the list's limit? Uses bounds on both motions only.
struct Reachable {
    Centres centres;
    View<const Near> built;
    View<const Vec3f> frame;
    View<const PlaneNow> planes;
    double unit, seconds, steps;

    GR_HD bool operator()(std::size_t i, std::size_t q) const {
        const PlaneNow& plane = planes[q];
        const Vec3d x = centres[i];
        const double gap = dot(plane.normal, x - plane.point) - centres.near[i].radius * unit;
        const double own = (static_cast<double>(length(frame[i])) * steps + 2.0 * built[i].radius) * unit;  // 2: trigger "published"
        const double turn = plane.reach_spin * (length(x - plane.centre) + own);
        return gap < (own + (plane.reach_speed + turn) * seconds) * (1 + 1e-9) + unit;
    }
};

template <class Law>
struct WallForces {
    Law law;
    Centres centres;
    View<const Body> body;
    View<const std::uint64_t> offsets;
    View<const std::uint32_t> partners;
    View<Vec3f> history;
    View<const PlaneNow> planes;
    View<const PairParameters> parameters;
    View<Wrench> wrench;
    double unit, inverse_force, inverse_torque;

    GR_HD void operator()(std::size_t i) const {
        for (std::uint64_t e = offsets[i], end = offsets[i + 1]; e < end; ++e) {
            const PlaneNow& plane = planes[partners[e]];
            const Vec3d x = centres[i];
            const double distance = dot(plane.normal, x - plane.point);
            const float overlap = static_cast<float>(centres.near[i].radius * unit - distance);
            if (!(overlap > 0)) {
                history[e] = Vec3f{};
                continue;
            }
            const Body& b = body[i];
            const Vec3f n = convert<float>(plane.normal);
            const float arm = fmaxf(static_cast<float>(centres.near[i].radius * unit) - 0.5f * overlap, 0.0f);
            const Vec3f from_centre = convert<float>(x - plane.centre) - n * arm;
            const Vec3f wall_velocity = plane.velocity + cross(plane.spin, from_centre);
            const Vec3f velocity = b.velocity - cross(b.spin * arm, n) - wall_velocity;
            Vec3f h = history[e];
            const Vec3f force = law(Contact{n, overlap, velocity, b.mass}, parameters[b.material * planes.size + partners[e]], h);
            history[e] = h;
            add(wrench[i], force, cross(n, force) * -arm);
        }
    }
    GR_HD void add(Wrench& w, const Vec3f& force, const Vec3f& torque) const {
        for (int a = 0; a < 3; ++a) {
            w.force[a] += quantize(force[a], inverse_force);
            w.torque[a] += quantize(torque[a], inverse_torque);
        }
    }
};

Centres centres_of(const State& s) { return {s.particles.near.view(), s.particles.far.view(), s.particles.scale.fine()}; }

}  // namespace

void wall_candidates(State& s, const StepConstants& constants, ContactList& walls) {
    const Reachable reachable{centres_of(s), s.built.view(), s.frame.view(), s.planes.view(), s.particles.scale.unit,
                              static_cast<double>(constants.dt) * s.age.limit, static_cast<double>(s.age.limit)};
    const std::size_t n = s.size(), planes = s.planes.size();
    walls.offsets.resize_discard(n + 1);
    walls.offsets.clear_bytes();
    const auto offsets = walls.offsets.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        std::uint64_t count = 0;
        for (std::size_t q = 0; q < planes; ++q) count += reachable(i, q);
        offsets[i] = count;
    });
    walls.partners.resize_discard_slack(exclusive_scan(offsets));
    walls.history.resize_discard_slack(walls.partners.size());
    const auto partners = walls.partners.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        std::uint64_t slot = offsets[i];
        for (std::size_t q = 0; q < planes; ++q)
            if (reachable(i, q)) partners[slot++] = static_cast<std::uint32_t>(q);
    });
}

void walls(State& s, ContactLaw law, const StepConstants& constants) {
    with_law(law, constants.dt, [&](auto functor) {
        for_each(s.size(), WallForces<decltype(functor)>{functor, centres_of(s), s.particles.body.view(), s.walls.offsets.view(),
                                                         s.walls.partners.view(), s.walls.history.view(), s.planes.view(),
                                                         s.wall_parameters.view(), s.wrench.view(), s.particles.scale.unit,
                                                         1.0 / s.quanta.force, 1.0 / s.quanta.torque});
    });
}

}  // namespace grainray::GRAINRAY_EXEC
