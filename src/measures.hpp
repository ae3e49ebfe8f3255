// What is measured of a state where it lies: sums over particles and contacts, the hash, the fields of a frame.
#pragma once

#include "state.hpp"

namespace grainray {

/// Sums and extremes over the particles and their contacts; SI units, world coordinates.
struct Totals {
    double kinetic_translation = 0, kinetic_rotation = 0, potential = 0;
    Vec3d momentum, angular_momentum;
    Vec3d lower{1e300, 1e300, 1e300}, upper{-1e300, -1e300, -1e300};  ///< of the spheres
    double max_speed = 0, max_overlap_ratio = 0;
    double contact_sides = 0;  ///< a pair has two, a contact with a plane one
    std::uint64_t contacts = 0;
};

/// What counts as gone wrong.
struct HealthLimits {
    double speed, overlap;  ///< m/s; overlap / smaller radius
    Vec3d lower, upper;     ///< the domain; infinite where it has no end
};

/// What the particles do to one mesh or the terrain.
struct SurfaceTotals {
    Vec3d force, torque;  ///< N; about the point the surface turns about, N m
    double max_overlap_ratio = 0;
    std::uint64_t contacts = 0;
};

/// Contact figures a particle, storage order. Forces are summed in quanta, so that no order of summing shows.
struct ContactFields {
    explicit ContactFields(Device device) : coordination(device), force(device) {}
    Array<std::uint32_t> coordination;
    Array<std::int64_t> force;  ///< sum of |f|, Quanta::force
};

}  // namespace grainray
