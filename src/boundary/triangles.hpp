// A sphere against a triangle. The plane of the triangle cuts the sphere in a disc; the triangle's share of that disc is
// its weight, so that a plane made of any triangles answers as one plane: the shares add up to 1.
// Uses + - * / sqrt alone, so that IEEE 754 fixes every bit on CPU and GPU.
#pragma once

#include "grainray/core.hpp"

namespace grainray {

/// In the frame of its surface, metres. The normal is right-handed about a, b, c. Aligned so that a GPU reads it in 16 bytes.
struct alignas(16) Triangle {
    Vec3d a, b, c, normal;
    std::uint32_t free_edges = 0;  ///< bit 0: ab, 1: bc, 2: ca belongs to no other triangle: a rim

    GR_HD Vec3d corner(int k) const { return k == 0 ? a : k == 1 ? b : c; }
    GR_HD bool is_free(int edge) const { return free_edges >> edge & 1; }
};

GR_HD inline Vec3d unit_normal(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Vec3d n = cross(b - a, c - a);
    const double size = length(n);
    return n * (1 / (size > 0 ? size : 1));
}

/// Where a point stands to an edge, in the plane of the triangle: height towards the inside, and the edge's two ends
/// along it as seen from the foot of the point.
struct EdgeView {
    double height, first, last;
};
GR_HD inline EdgeView edge_view(const Triangle& t, int edge, const Vec3d& x) {
    const Vec3d from = t.corner(edge), along = t.corner(edge == 2 ? 0 : edge + 1) - from;
    const double size = length(along);
    const Vec3d direction = along * (1 / (size > 0 ? size : 1)), p = x - from;
    const double first = -dot(direction, p);
    return {dot(cross(t.normal, direction), p), first, first + size};
}

/// Which side of a band of half-width `width` round an edge's line a point is on: +1 inside, -1 outside, 0 in the band or
/// too near to it for rounding. No root is taken.
GR_HD inline int beside_edge(const Triangle& t, int edge, const Vec3d& x, double square_width) {
    const Vec3d from = t.corner(edge), along = t.corner(edge == 2 ? 0 : edge + 1) - from;
    const double height = dot(cross(t.normal, along), x - from);
    if (!(height * height > square_width * dot(along, along) * (1 + 1e-9))) return 0;
    return height > 0 ? 1 : -1;
}

/// Could any point of the triangle lie within `reach` of x? Never false where one does.
GR_HD inline bool within_reach(const Triangle& t, const Vec3d& x, double reach) {
    const double distance = dot(t.normal, x - t.a), square = (reach - distance) * (reach + distance);
    if (!(square > 0)) return false;
    for (int edge = 0; edge < 3; ++edge)
        if (beside_edge(t, edge, x, square) < 0) return false;
    return true;
}

namespace disc {

/// Angle of (x, y) from the x axis, x >= 0; to 3e-8 (Abramowitz & Stegun 4.4.49).
GR_HD inline float angle(float x, float y) {
    const float size = fabsf(y), most = fmaxf(x, size), q = fminf(x, size) / (most > 0 ? most : 1.0f), s = q * q;
    const float p = q + q * s * (-0.3333314528f + s * (0.1999355085f + s * (-0.1420889944f + s * (0.1065626393f +
                    s * (-0.0752896400f + s * (0.0429096138f + s * (-0.0161657367f + s * 0.0028662257f)))))));
    const float turned = size > x ? 1.57079632679f - p : p;
    return y < 0 ? -turned : turned;
}

/// Share of the unit disc between an edge and the arc beyond it; negative where the centre is beyond the edge.
GR_HD inline float cut_off(const EdgeView& e, double inverse_radius) {
    const float h = static_cast<float>(e.height * inverse_radius), size = fabsf(h);
    if (!(size < 1)) return 0;
    const float c = sqrtf(1 - h * h);
    const double first = e.first * inverse_radius, last = e.last * inverse_radius;
    const float s1 = first < -c ? -c : first > c ? c : static_cast<float>(first), s2 = last < -c ? -c : last > c ? c : static_cast<float>(last);
    const float turn = angle(size, s2) - angle(size, s1);
    return ((h < 0 ? -turn : turn) - h * (s2 - s1)) * 0.159154943092f;
}

}  // namespace disc

/// What one triangle means to a sphere.
struct Section {
    double distance = 0;  ///< of the centre from the plane, positive where the normal points
    float share = 0;      ///< of the disc, 0 to 1: the triangle is touched where it is positive
    bool rim = false;     ///< touched at a free edge, by the point `nearest`
    Vec3d nearest;
};

/// Beyond a free edge nothing takes over from the triangle. So the disc counts as whole there while the centre's foot is
/// inside, and once it is outside the edge acts as a wire.
GR_HD inline Section section(const Triangle& t, const Vec3d& x, double radius) {
    Section s;
    s.distance = dot(t.normal, x - t.a);
    const double square = (radius - s.distance) * (radius + s.distance);
    if (!(square > 0)) return s;
    const double disc_radius = sqrt(square), inverse = 1 / disc_radius;
    float cut = 0;
    double rim_height = -disc_radius;
    bool apart = false, above = true;
    for (int edge = 0; edge < 3; ++edge) {
        const int beside = beside_edge(t, edge, x, square);
        if (beside > 0) continue;
        if (beside < 0) {
            s.rim = false;
            return s;
        }
        const EdgeView e = edge_view(t, edge, x);
        above = above && e.height >= 0;
        apart = apart || e.height <= -disc_radius;
        if (!t.is_free(edge)) {
            cut += disc::cut_off(e, inverse);
        } else if (e.height < 0 && e.first <= 0 && e.last > 0 && e.height > rim_height) {
            const Vec3d from = t.corner(edge), along = t.corner(edge == 2 ? 0 : edge + 1) - from;
            rim_height = e.height;
            s.rim = true;
            s.nearest = from + along * (-e.first / (e.last - e.first));
        }
    }
    const float share = (above ? 1.0f : 0.0f) - cut;
    s.rim = s.rim && !apart;
    s.share = s.rim ? 1.0f : apart || share < 0 ? 0.0f : share;
    return s;
}

}  // namespace grainray
