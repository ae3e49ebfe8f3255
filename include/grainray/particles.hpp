// The state of the particles: one array a field, on one device, in storage order (ids survive sorting).
//
// Positions are 64-bit fixed point: an integer number of fine units from the world's origin, so the same motion happens
// anywhere in the world to the last bit. A position is kept in two 32-bit words an axis:
//   near  bits 12..43: pairs subtract these. Neighbours are less than 2^30 units apart, so the wrapped 32-bit
//         difference is their exact separation and the squared distance is an exact 64-bit integer
//   far   bits 44..63 and the 12 bits below one unit, where slow motion accumulates
#pragma once

#include "grainray/device.hpp"

namespace grainray {

inline constexpr int fine_bits = 12;  ///< fine units a unit, as a power of two

/// Centre (units, wrapped) and radius (units): all that decides whether two spheres touch. One 16-byte read.
struct alignas(16) Near {
    std::int32_t x, y, z, radius;
};
struct Far {
    std::int32_t x, y, z;
};
/// What a contact needs of a particle besides its place: m/s, kg, rad/s, row of the material table.
struct alignas(16) Body {
    Vec3f velocity;
    float mass;
    Vec3f spin;
    std::uint32_t material;
};

GR_HD constexpr std::int64_t join(std::int32_t near, std::int32_t far) {
    const std::int64_t low = static_cast<std::int64_t>(static_cast<std::uint32_t>(near)) << fine_bits;
    const std::uint64_t high = static_cast<std::uint64_t>(static_cast<std::int64_t>(far >> fine_bits)) << (32 + fine_bits);
    return static_cast<std::int64_t>(high | static_cast<std::uint64_t>(low) | static_cast<std::uint64_t>(far & ((1 << fine_bits) - 1)));
}
GR_HD constexpr std::int32_t near_of(std::int64_t p) { return static_cast<std::int32_t>(static_cast<std::uint32_t>(p >> fine_bits)); }
GR_HD constexpr std::int32_t far_of(std::int64_t p) {
    return static_cast<std::int32_t>((p >> (32 + fine_bits)) << fine_bits | (p & ((1 << fine_bits) - 1)));
}
GR_HD constexpr Vec3l join(const Near& n, const Far& f) { return {join(n.x, f.x), join(n.y, f.y), join(n.z, f.z)}; }
GR_HD constexpr Far far_of(const Vec3l& p) { return {far_of(p.x), far_of(p.y), far_of(p.z)}; }

/// Position p inside the periodic box: fine units, period in units, 0 where an axis is not periodic.
GR_HD constexpr Vec3l into_box(Vec3l p, const Vec3l& period, const Vec3l& lower) {
    for (int a = 0; a < 3; ++a) {
        const std::int64_t width = period[a] * (1 << fine_bits);
        if (width == 0) continue;
        const std::int64_t r = (p[a] - lower[a]) % width;
        p[a] = lower[a] + (r < 0 ? r + width : r);
    }
    return p;
}

/// Fixed point to metres and back. unit is a power of two with the largest radius in (2^26, 2^27] units, so a unit is
/// about 1e-8 of that radius, a fine unit 3e-12, and the world reaches 1e7 radii either way.
struct PositionScale {
    double unit = 1;  ///< m
    Vec3d origin;     ///< world position of fixed-point zero, m

    static PositionScale for_radius(double largest_radius, const Vec3d& origin);
    GR_HD double fine() const { return unit / (1 << fine_bits); }
    GR_HD Vec3d local(const Vec3l& p) const { return convert<double>(p) * fine(); }
    GR_HD Vec3d world(const Vec3l& p) const { return local(p) + origin; }
    /// Nearest fixed-point position; throws InputError outside the range.
    Vec3l fixed(const Vec3d& world) const;
};

struct Particles {
    explicit Particles(Device device) : near(device), far(device), body(device), remainder(device), id(device) {}
    Array<Near> near;
    Array<Far> far;
    Array<Body> body;
    Array<Vec3f> remainder;  ///< what rounding kept from the velocity so far, m/s: added to the next change (Kahan 1965)
    Array<std::uint32_t> id;
    PositionScale scale;
    std::size_t size() const { return near.size(); }
};

}  // namespace grainray
