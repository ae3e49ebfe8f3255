// THE predicate. Brute force, cells and every ray back end, on every device, decide by this and nothing else.
// Compiled without contraction (no fused multiply-add), so that each operation rounds as written.
#pragma once

#include "grainray/core.hpp"

namespace grainray::neighbors {

/// A point and its reach: one 16-byte read.
struct alignas(16) Sphere {
    float x, y, z, reach;
};

/// Shortest image of a coordinate difference of two points inside the box; period 0 means none.
GR_HD inline float nearest_image(float d, float period) {
    const float half = 0.5f * period;
    if (d > half) return d - period;
    if (d < -half) return d + period;
    return d;
}

/// |a - b| < R_a + R_b. Symmetric in a and b to the last bit.
GR_HD inline bool pair_test(const Sphere& a, const Sphere& b) {
    const float dx = a.x - b.x, dy = a.y - b.y, dz = a.z - b.z;
    const float reach = a.reach + b.reach;
    return (dx * dx + dy * dy) + dz * dz < reach * reach;
}
GR_HD inline bool pair_test(const Sphere& a, const Sphere& b, const Vec3f& period) {
    const float dx = period.x > 0 ? nearest_image(a.x - b.x, period.x) : a.x - b.x;
    const float dy = period.y > 0 ? nearest_image(a.y - b.y, period.y) : a.y - b.y;
    const float dz = period.z > 0 ? nearest_image(a.z - b.z, period.z) : a.z - b.z;
    const float reach = a.reach + b.reach;
    return (dx * dx + dy * dy) + dz * dz < reach * reach;
}

/// Owner rule: the pair belongs to the point with the larger (reach, id). Since d < R_a + R_b <= 2 R_owner, the owner
/// finds it in a box of half-width 2 R_owner.
GR_HD inline bool owns(const Sphere& a, std::uint32_t id_a, const Sphere& b, std::uint32_t id_b) {
    return (a.reach > b.reach) | ((a.reach == b.reach) & (id_a > id_b));  // no branch: its side is a coin toss
}

}  // namespace grainray::neighbors
