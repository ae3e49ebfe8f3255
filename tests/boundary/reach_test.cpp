// Which facets are left out before a contact is evaluated: never one that has a point within reach.
#include <gtest/gtest.h>

#include "boundary/facets.hpp"
#include "meshes.hpp"

namespace grainray::test {
namespace {

/// Distance of x from a triangle: from its plane above the inside, else from the nearest edge.
double distance(const Triangle& t, const Vec3d& x) {
    double least = 1e300;
    bool inside = true;
    for (int edge = 0; edge < 3; ++edge) {
        const Vec3d from = t.corner(edge), along = t.corner((edge + 1) % 3) - from, p = x - from;
        inside = inside && dot(cross(t.normal, along), p) >= 0;
        least = std::min(least, length(p - along * std::clamp(dot(p, along) / dot(along, along), 0.0, 1.0)));
    }
    return inside ? std::fabs(dot(t.normal, x - t.a)) : least;
}

Vec3d somewhere(Dice& u, double half) {
    const double x = u(-half, half), y = u(-half, half);
    return {x, y, u(-half, half)};
}

TEST(Reach, OfATriangle) {
    Dice u(7);
    int near = 0, left_out = 0;
    for (int k = 0; k < 20000; ++k) {
        Triangle t{somewhere(u, 1), somewhere(u, 1), somewhere(u, 1), {}};
        t.normal = unit_normal(t.a, t.b, t.c);
        const Vec3d x = somewhere(u, 1.5);
        const double apart = distance(t, x);
        EXPECT_TRUE(within_reach(t, x, apart * (1 + 1e-9))) << k;
        if (within_reach(t, x, apart * 0.9)) ++near;
        else ++left_out;
    }
    EXPECT_GT(left_out, 5 * near);  // those that stay are beyond corners
}

TEST(Reach, OfAFacetOfTerrain) {
    Dice u(8);
    Facets f(Device::cpu);
    Surface s;
    s.terrain = true;
    s.nx = 6;
    s.ny = 5;
    s.nz = 1;
    s.count = 60;
    s.lower = {-3, 2, 0};
    s.width = {1, 0.7, 1};
    f.surfaces.assign(std::vector{s});
    std::vector<double> heights;
    for (int k = 0; k < 42; ++k) heights.push_back(u(-0.5, 0.5));
    f.heights.assign(heights);
    const FacetShapes shapes = shapes_of(f);
    int left_out = 0, others = 0;
    for (std::uint32_t id = 0; id < s.count; ++id)
        for (int k = 0; k < 500; ++k) {
            const Vec3d x{u(-4, 4), u(1, 6.5), u(-1, 1)};
            const double apart = distance(shapes.facet(s, id), x);
            EXPECT_FALSE(shapes.apart(s, id, x, apart * (1 + 1e-6))) << id;
            ++(shapes.apart(s, id, x, apart * 0.7) ? left_out : others);
        }
    EXPECT_GT(left_out, 8 * others);
}

}  // namespace
}  // namespace grainray::test
