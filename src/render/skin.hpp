// Surfaces of triangles as rays see them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/math.hpp"

namespace grainray::picture {

/// Everything relative to the subject's origin.
struct Skin {
    std::vector<Vec3f> vertices, normals;                  ///< one normal a vertex: surfaces look as smooth as these are
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::array<Vec3f, 2>> edges;               ///< rims and creases, drawn as lines

    /// The smooth normal at a point of a triangle, on the side of the triangle that is seen along `ray`. Near an outline it
    /// may lean away from the eye, which must not turn it over.
    Vec3f normal(std::uint32_t triangle, float u, float v, const Vec3f& ray) const {
        const auto& [a, b, c] = triangles[triangle];
        const Vec3f smooth = normalized(normals[a] * (1 - u - v) + normals[b] * u + normals[c] * v);
        const Vec3f flat = cross(vertices[b] - vertices[a], vertices[c] - vertices[a]);
        return (dot(flat, ray) < 0) == (dot(flat, smooth) > 0) ? smooth : -smooth;
    }
};

}  // namespace grainray::picture
