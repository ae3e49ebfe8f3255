// Boxes for ray tracers that no rounding can open: of the predicate, of periodic images, of a box's own corners, of the
// tracer's test whether a point is in a box. A tracer proposes, the predicate decides, so a box may be too wide, never too
// narrow.
#pragma once

#include "neighbors/pair_test.hpp"

namespace grainray::neighbors::rays {

/// Points are clamped to +-farthest: Embree drops boxes beyond 1.8e18 in silence, and a square must not overflow.
constexpr float farthest = 1e18f;

GR_HD inline float clamp(float v, float least, float most) { return v < least ? least : v > most ? most : v; }
GR_HD inline float held(float v) { return clamp(v, -farthest, farthest); }
GR_HD inline Vec3f held(const Vec3f& v) { return {held(v.x), held(v.y), held(v.z)}; }
/// Corners are clamped so that a point that was in the box stays in it, and never on its face.
GR_HD inline float held_lower(float v) { return clamp(v, -1.5f * farthest, 0.99f * farthest); }
GR_HD inline float held_upper(float v) { return -held_lower(-v); }

GR_HD inline float magnitude(float v) { return v < 0 ? -v : v; }

/// What a distance w along an axis may lose: 4e-6 of itself, eight roundings of the coordinates (`size` bounds them), and
/// 1e-22, since the squares of shorter distances are no longer normal numbers.
GR_HD inline float pad(float w, float size) { return w * 4e-6f + size * 5e-7f + 1e-22f; }

/// Bounds the coordinates that meet at x: its own, and those of its images.
GR_HD inline float size_at(float x, float period) { return magnitude(x) + 2 * period; }

struct Bounds {
    Vec3f lower, upper;
};

/// Every point that the predicate may find closer than w to c along each axis.
GR_HD inline Bounds box_around(const Vec3f& c, float w, const Vec3f& period) {
    const Vec3f h{w + pad(w, size_at(c.x, period.x) + w), w + pad(w, size_at(c.y, period.y) + w), w + pad(w, size_at(c.z, period.z) + w)};
    return {{held_lower(c.x - h.x), held_lower(c.y - h.y), held_lower(c.z - h.z)}, {held_upper(c.x + h.x), held_upper(c.y + h.y), held_upper(c.z + h.z)}};
}

// The default search: a point of the common reach or less has a box of half-width reach + common, on its left side alone,
// and finds the common points there; a larger one has a box of half-width 2 reach, and finds all those that it owns. Each
// pair has one finder, and nothing but `common`, which is chosen for speed, depends on the reaches of others.

GR_HD inline Bounds finder_box(const Sphere& s, float common, const Vec3f& period) {
    const bool half = s.reach <= common;
    Bounds b = box_around({s.x, s.y, s.z}, half ? s.reach + common : 2 * s.reach, period);
    if (half) b.upper.x = held_upper(s.x + pad(0, size_at(s.x, period.x)));
    return b;
}

/// Whether the pair is found by b, the point of a box, from a ray at a. `dx` is a.x - b.x of the images compared; the
/// places of the points in any one order break ties.
GR_HD inline bool finds(const Sphere& b, std::uint32_t place_b, const Sphere& a, std::uint32_t place_a, float dx, float common) {
    if (b.reach > common) return owns(b, place_b, a, place_a);
    return (a.reach <= common) & ((dx < 0) | ((dx == 0) & (place_b > place_a)));
}

/// Calls visit(shift) for shift (0, 0, 0) and, on periodic axes, the images next to it.
template <class Visit>
GR_HD inline void for_each_image(const Vec3f& period, const Visit& visit) {
    const int nx = period.x > 0, ny = period.y > 0, nz = period.z > 0;
    for (int z = -nz; z <= nz; ++z)
        for (int y = -ny; y <= ny; ++y)
            for (int x = -nx; x <= nx; ++x) visit(Vec3i{x, y, z});
}

GR_HD inline Vec3f image(const Sphere& s, const Vec3i& shift, const Vec3f& period) {
    return {s.x + static_cast<float>(shift.x) * period.x, s.y + static_cast<float>(shift.y) * period.y, s.z + static_cast<float>(shift.z) * period.z};
}

/// The image of a that the predicate compares with b, along one axis (nearest_image in pair_test.hpp).
GR_HD inline int nearest_shift(float d, float period) { return (d < -0.5f * period) - (d > 0.5f * period); }

/// True for one image of a alone, the one the predicate compares with b: a pair seen through several images counts once.
GR_HD inline bool is_nearest(const Sphere& a, const Vec3i& shift, const Sphere& b, const Vec3f& period) {
    return (period.x > 0 ? nearest_shift(a.x - b.x, period.x) : 0) == shift.x && (period.y > 0 ? nearest_shift(a.y - b.y, period.y) : 0) == shift.y &&
           (period.z > 0 ? nearest_shift(a.z - b.z, period.z) : 0) == shift.z;
}

}  // namespace grainray::neighbors::rays
