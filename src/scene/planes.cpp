// [planes.NAME] -> Plane, and where a plane is at a time.
#include <fmt/format.h>

#include <cmath>

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

    plane.motion = read_motion(table, s);
    return plane;
}

}  // namespace scene

PlaneState plane_at(const Plane& plane, double time) {
    const Motion& m = plane.motion;
    const MotionState now = motion_at(m, time);
    PlaneState state{plane.point + now.shift, plane.normal, now.velocity, now.angular_velocity, m.rotation_point + now.shift};
    if (now.angle != 0) {
        state.point = state.centre + turned(plane.point - m.rotation_point, m.rotation_axis, now.angle);
        state.normal = turned(plane.normal, m.rotation_axis, now.angle);
    }
    return state;
}

}  // namespace grainray
