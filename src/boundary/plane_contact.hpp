// One particle and the planes near it.
#pragma once

#include "boundary/plane_force.hpp"

namespace grainray {

struct Centres {
    View<const Near> near;
    View<const Far> far;
    double fine;
    explicit Centres(const Particles& p) : near(p.near.view()), far(p.far.view()), fine(p.scale.fine()) {}
    GR_HD Vec3d operator[](std::size_t i) const { return convert<double>(join(near[i], far[i])) * fine; }
};

template <class Law>
struct PlaneContacts {
    Law law;
    View<const std::uint64_t> offsets;
    View<const std::uint32_t> partners;
    View<Vec3f> history;
    View<const PlaneNow> planes;
    View<const PairParameters> parameters;  ///< materials x planes
    std::uint32_t plane_count;
    double unit;
    float inverse_force, inverse_torque;

    PlaneContacts(const State& s, const Law& contact_law)
        : law(contact_law), offsets(s.walls.offsets.view()), partners(s.walls.partners.view()),
          history{const_cast<Vec3f*>(s.walls.history.data()), s.walls.history.size()}, planes(s.planes.view()),
          parameters(s.wall_parameters.view()), plane_count(s.plane_count), unit(s.particles.scale.unit),
          inverse_force(static_cast<float>(1.0 / s.quanta.force)), inverse_torque(static_cast<float>(1.0 / s.quanta.torque)) {}

    /// Adds what the planes do to particle i. x: its centre, m; first_plane: where this step's planes begin.
    GR_HD void add(std::size_t i, const Vec3d& x, std::int32_t radius, const Body& b, std::size_t first_plane, Wrench& w) const {
        for (std::uint64_t e = offsets[i], end = offsets[i + 1]; e < end; ++e) {
            const std::uint32_t q = partners[e];
            const PlaneNow& plane = planes[first_plane + q];
            const float overlap = plane_overlap(plane, x, radius, unit);
            if (!(overlap > 0)) {
                history[e] = Vec3f{};
                continue;
            }
            Vec3f h = history[e];
            const PlaneForce f = plane_force(law, plane, x, radius, unit, overlap, b.velocity, b.spin, b.mass,
                                             parameters[b.material * plane_count + q], h);
            history[e] = h;
            for (int a = 0; a < 3; ++a) {
                w.force[a] += quantize(f.force[a], inverse_force);
                w.torque[a] += quantize(f.torque[a], inverse_torque);
            }
        }
    }
};

}  // namespace grainray
