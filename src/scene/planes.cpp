// [planes.NAME] -> Plane, and where a moving plane is.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/read.hpp"

namespace grainray {
namespace scene {

Plane read_plane(const Node& table, const std::string& name, const Scene& s) {
    Plane plane;
    plane.name = name;
    read_table(table, schema().plane, plane, {"motion"});
    check_material(table.child("material"), plane.material, s);
    plane.normal = unit_vector(table, "normal", plane.normal);
    for (int axis = 0; axis < 3; ++axis)
        if (s.domain.periodic[static_cast<std::size_t>(axis)] && std::fabs(plane.normal[axis]) > 1e-12)
            fail_key(table, "normal",
                     fmt::format("faces the periodic axis {0}, along which every particle goes round and would meet the plane from "
                                 "behind; give a normal without {0} or close the axis in domain.periodic", "xyz"[axis]));

    Motion& m = plane.motion;
    const Node motion = table.child("motion"), rotation = motion.child("rotation"),
               oscillation = motion.child("oscillation");
    read_table(motion, schema().motion, m, {"rotation", "oscillation"});
    if (!(m.stop > m.start)) fail_key(motion, "stop", fmt::format("must be greater than start ({} s)", m.start));
    if (motion.has("rotation")) {
        read_table(rotation, schema().rotation, m);
        m.rotation_axis = unit_vector(rotation, "axis", m.rotation_axis);
    }
    if (motion.has("oscillation")) read_table(oscillation, schema().oscillation, m);
    return plane;
}

namespace {

/// v turned by an angle about a unit axis (Rodrigues).
Vec3d rotated(const Vec3d& v, const Vec3d& axis, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
}

}  // namespace
}  // namespace scene

PlaneState plane_at(const Plane& plane, double time) {
    const Motion& m = plane.motion;
    const bool moving = m.moves() && time >= m.start && time < m.stop;
    const double t = std::max(0.0, std::min(time, m.stop) - m.start);  // how long it has moved
    const double omega = 2 * std::numbers::pi * m.oscillation_frequency, phase = omega * t + m.oscillation_phase;
    const Vec3d shift = m.velocity * t + m.oscillation_amplitude * (std::sin(phase) - std::sin(m.oscillation_phase));

    PlaneState state{plane.point + shift, plane.normal, {}, {}, m.rotation_point + shift};
    if (m.rotation_rate != 0 && t > 0) {
        state.point =
            state.centre + scene::rotated(plane.point - m.rotation_point, m.rotation_axis, m.rotation_rate * t);
        state.normal = scene::rotated(plane.normal, m.rotation_axis, m.rotation_rate * t);
    }
    if (moving) {
        state.velocity = m.velocity + m.oscillation_amplitude * (omega * std::cos(phase));
        state.angular_velocity = m.rotation_axis * m.rotation_rate;
    }
    return state;
}

}  // namespace grainray
