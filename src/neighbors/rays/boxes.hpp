// Boxes for ray tracers that no rounding can open: of the predicate, of periodic images, of a box's own corners, of the
// tracer's test whether a point is in a box. A tracer proposes, the predicate decides, so a box may be too wide, never too
// narrow.
#pragma once

#include <cmath>
#include <initializer_list>

#include "neighbors/pair_test.hpp"

namespace grainray::neighbors::rays {

struct Bounds {
    Vec3f lower, upper;
};

GR_HD inline float magnitude(float v) { return v < 0 ? -v : v; }

/// The tracer's world: the caller's, times a power of two that brings it to the size of 1. Tracers have limits of their own
/// (Embree drops boxes beyond 1.8e18 in silence, GPUs lose boxes smaller than 1e-20), the scaling rounds nothing.
struct Frame {
    float scale = 1;
    Vec3f period{};  ///< in the caller's world, as everything that is handed in

    /// What a distance w about x may lose along an axis, scaled: 4e-6 of itself, eight roundings of the coordinates that meet
    /// there, and 1e-22 of the caller's, since the squares of shorter distances are no normal numbers.
    GR_HD float pad(float w, float x, float length) const {
        return (w * scale) * 4e-6f + (magnitude(x * scale) + w * scale + 2 * (length * scale)) * 5e-7f + 1e-22f * scale;
    }
    GR_HD Vec3f point(const Vec3f& c) const { return c * scale; }

    /// Every point that the predicate may find closer than w + extra to c along each axis.
    GR_HD Bounds box(const Vec3f& c, float w) const {
        w = w < 3e38f ? w : 3e38f;  // farther apart squares overflow, and nothing is near
        const Vec3f p = point(c), h{w * scale + pad(w, c.x, period.x), w * scale + pad(w, c.y, period.y), w * scale + pad(w, c.z, period.z)};
        return {p - h, p + h};
    }
};

/// A frame for points within all the bounds whose boxes are up to `widest` wide to each side.
inline Frame frame_of(std::initializer_list<Bounds> all, float widest, const Vec3f& period) {
    double size = widest;
    for (const Bounds& b : all)
        for (int a = 0; a < 3; ++a) size = std::fmax(size, std::fmax(std::fabs(b.lower[a]), std::fabs(b.upper[a])) + 2.0 * period[a]);
    const int exponent = size > 0 ? std::ilogb(size) : 0;
    return {std::ldexp(1.0f, exponent > 110 ? -110 : exponent < -100 ? 100 : -exponent), period};
}

// The default search on a GPU. Rays of small points, up to the reach `small`, meet a box of every point: a small one's has
// half-width reach + small and lies on its left side alone, a larger one's has that half-width on both sides. Rays of larger
// points start `beside`, in a second world where only larger points have boxes, so that nobody meets a box made for others:
// up to the reach `common` again of half-width reach + common on the left side alone; beyond, of 2 reach, for all those that
// the point owns. Each pair has one finder, and nothing but `small` and `common`, which are chosen for speed, depends on the
// reaches of others.

struct Classes {
    float small, common;
    float beside;  ///< along x, in the tracer's frame: farther than any box is wide
};

GR_HD inline Bounds left_half(const Sphere& s, float width, const Frame& frame) {
    Bounds b = frame.box({s.x, s.y, s.z}, width);
    b.upper.x = s.x * frame.scale + frame.pad(0, s.x, frame.period.x);
    return b;
}

/// The box that rays of small points meet.
GR_HD inline Bounds box_for_small(const Sphere& s, const Classes& classes, const Frame& frame) {
    if (s.reach <= classes.small) return left_half(s, s.reach + classes.small, frame);
    return frame.box({s.x, s.y, s.z}, s.reach + classes.small);
}

/// The box of a larger point that rays of larger points meet.
GR_HD inline Bounds box_for_larger(const Sphere& s, const Classes& classes, const Frame& frame) {
    Bounds b = s.reach <= classes.common ? left_half(s, s.reach + classes.common, frame) : frame.box({s.x, s.y, s.z}, 2 * s.reach);
    const float rounding = 2.5e-7f * (magnitude(b.lower.x) + magnitude(b.upper.x) + classes.beside);
    b.lower.x = (b.lower.x + classes.beside) - rounding;
    b.upper.x = (b.upper.x + classes.beside) + rounding;
    return b;
}

/// Whether the pair is found by b, the point of a box, from a ray at a. `dx` is a.x - b.x of the images compared; the
/// places of the points in any one order break ties.
GR_HD inline bool finds(const Sphere& b, std::uint32_t place_b, const Sphere& a, std::uint32_t place_a, float dx, const Classes& classes) {
    const bool left = (dx < 0) | ((dx == 0) & (place_b > place_a));
    if (a.reach <= classes.small) return (b.reach > classes.small) | left;
    if (b.reach <= classes.small) return false;
    if (b.reach > classes.common) return owns(b, place_b, a, place_a);
    return (a.reach <= classes.common) & left;
}

/// Calls visit(shift) for shift (0, 0, 0) and, on periodic axes, the images next to it.
template <class Visit>
GR_HD inline void for_each_image(const Vec3f& period, const Visit& visit) {
    const int nx = period.x > 0, ny = period.y > 0, nz = period.z > 0;
    for (int z = -nz; z <= nz; ++z)
        for (int y = -ny; y <= ny; ++y)
            for (int x = -nx; x <= nx; ++x) visit(Vec3i{x, y, z});
}

GR_HD inline Vec3f image(const Vec3f& c, const Vec3i& shift, const Vec3f& period) {
    return {c.x + static_cast<float>(shift.x) * period.x, c.y + static_cast<float>(shift.y) * period.y, c.z + static_cast<float>(shift.z) * period.z};
}

/// The image of a that the predicate compares with b, along one axis (nearest_image in pair_test.hpp).
GR_HD inline int nearest_shift(float d, float period) { return (d < -0.5f * period) - (d > 0.5f * period); }

/// True for one image of a alone, the one the predicate compares with b: a pair seen through several images counts once.
GR_HD inline bool is_nearest(const Sphere& a, const Vec3i& shift, const Sphere& b, const Vec3f& period) {
    return (period.x > 0 ? nearest_shift(a.x - b.x, period.x) : 0) == shift.x && (period.y > 0 ? nearest_shift(a.y - b.y, period.y) : 0) == shift.y &&
           (period.z > 0 ? nearest_shift(a.z - b.z, period.z) : 0) == shift.z;
}

}  // namespace grainray::neighbors::rays
