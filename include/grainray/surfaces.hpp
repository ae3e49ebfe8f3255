// Geometry of boundaries made of triangles: meshes and grids of elevations, as files hold them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "grainray/core.hpp"

namespace grainray {

struct TriangleMesh {
    std::vector<Vec3d> vertices;                           ///< m
    std::vector<std::array<std::uint32_t, 3>> triangles;   ///< indices of vertices
};

/// Elevations at the nodes of a regular grid.
struct ElevationGrid {
    std::int64_t columns = 0, rows = 0;   ///< nodes along x and y
    double x = 0, y = 0;                  ///< of the first node, the one in the south-west, m
    double dx = 0, dy = 0;                ///< distance of nodes, m
    std::vector<double> heights;          ///< m; x runs fastest, then northwards; NaN: a hole

    double at(std::int64_t i, std::int64_t j) const { return heights[static_cast<std::size_t>(j * columns + i)]; }
    bool same_nodes(const ElevationGrid&) const;
    /// Height of the surface of triangles above a point; NaN outside and in holes.
    double height(double x, double y) const;
    /// Length along the surface over length in the map, along the steepest way: 1 on the level.
    double steepness(double x, double y) const;
    /// Rise over run along x, y (and 0) of the triangle at a point; beyond the rim that of the nearest one.
    Vec3d slope(double x, double y) const;
    /// The same surface with every cell cut into factor x factor by cubic interpolation (Catmull-Rom): a smoother one.
    ElevationGrid refined(std::int64_t factor) const;
};

/// What is odd about a mesh; `grainray check` reports it.
struct MeshReport {
    std::size_t triangles = 0, vertices = 0;
    std::size_t degenerate = 0;    ///< no area: left out
    std::size_t duplicates = 0;    ///< same three corners as another: left out
    std::size_t slivers = 0;       ///< height below 1e-3 of the longest edge
    std::size_t reversed = 0;      ///< turned over, so that neighbours face the same way
    std::size_t free_edges = 0;    ///< edges of one triangle alone: rims, or gaps
    std::size_t crowded_edges = 0; ///< edges of three triangles or more
    std::size_t parts = 0;         ///< pieces that share no edge
    double area = 0;               ///< m2
    Box bounds{};                  ///< m
};

}  // namespace grainray
