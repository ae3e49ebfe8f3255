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

    /// The normal at a point of a triangle, not of unit length where those of its corners differ.
    Vec3f normal(std::uint32_t triangle, float u, float v) const {
        const auto& [a, b, c] = triangles[triangle];
        return normals[a] * (1 - u - v) + normals[b] * u + normals[c] * v;
    }
};

}  // namespace grainray::picture
