// One sphere against one plane. A plane is a half-space: the overlap is r - signed distance, however deep a centre may lie.
#pragma once

#include "state.hpp"

namespace grainray {

/// Overlap, m; they touch where it is positive. x: the centre, m; radius in units.
GR_HD inline float plane_overlap(const PlaneNow& plane, const Vec3d& x, std::int32_t radius, double unit) {
    return static_cast<float>(radius * unit - dot(plane.normal, x - plane.point));
}

/// Force and torque on a sphere that touches.
struct PlaneForce {
    Vec3f force, torque;
};
template <class Law>
GR_HD inline PlaneForce plane_force(const Law& law, const PlaneNow& plane, const Vec3d& x, std::int32_t radius, double unit, float overlap,
                                    const Vec3f& velocity, const Vec3f& spin, float mass, const PairParameters& parameters, Vec3f& history) {
    const Vec3f n = convert<float>(plane.normal);
    const float lever = static_cast<float>(radius * unit) - 0.5f * overlap, arm = lever > 0 ? lever : 0.0f;
    const Vec3f from_centre = convert<float>(x - plane.centre) - n * arm;
    const Vec3f wall_velocity = plane.velocity + cross(plane.spin, from_centre);
    const Vec3f at_contact = velocity - cross(spin * arm, n) - wall_velocity;
    const Vec3f force = law(Contact{n, overlap, at_contact, mass}, parameters, history);
    return {force, cross(n, force) * -arm};
}

}  // namespace grainray
