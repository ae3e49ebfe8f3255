// Triangles into cells: about a cell or two a triangle, fewer where triangles are long.
#include <algorithm>
#include <cmath>

#include "surfaces/surfaces.hpp"

namespace grainray::surfaces {
namespace {

Vec3d least(const Triangle& t) { return {std::min({t.a.x, t.b.x, t.c.x}), std::min({t.a.y, t.b.y, t.c.y}), std::min({t.a.z, t.b.z, t.c.z})}; }
Vec3d most(const Triangle& t) { return {std::max({t.a.x, t.b.x, t.c.x}), std::max({t.a.y, t.b.y, t.c.y}), std::max({t.a.z, t.b.z, t.c.z})}; }

struct CellRange {
    std::int32_t lower[3], upper[3];
    std::uint64_t size() const {
        std::uint64_t n = 1;
        for (int a = 0; a < 3; ++a) n *= static_cast<std::uint64_t>(upper[a] - lower[a] + 1);
        return n;
    }
};

CellRange range(const Surface& s, const Triangle& t) {
    const Vec3d lo = least(t), hi = most(t);
    const std::int32_t cells[3] = {s.nx, s.ny, s.nz};
    CellRange r{};
    for (int a = 0; a < 3; ++a) {
        r.lower[a] = FacetShapes::cell(lo[a], s.lower[a], s.width[a], cells[a]);
        r.upper[a] = FacetShapes::cell(hi[a], s.lower[a], s.width[a], cells[a]);
    }
    return r;
}

/// A box of cells of about the given edge.
void divide(Surface& s, const Vec3d& extent, double edge) {
    const auto count = [&](double length) { return static_cast<std::int32_t>(std::clamp(std::floor(length / edge), 1.0, 1024.0)); };
    s.nx = count(extent.x);
    s.ny = count(extent.y);
    s.nz = count(extent.z);
    s.width = {extent.x / s.nx, extent.y / s.ny, extent.z / s.nz};
}

std::uint64_t entries(const Surface& s, const std::vector<Triangle>& triangles) {
    std::uint64_t sum = 0;
    for (const Triangle& t : triangles) sum += range(s, t).size();
    return sum;
}

template <class Visit>
void each_cell(const Surface& s, const CellRange& r, const Visit& visit) {
    for (std::int32_t k = r.lower[2]; k <= r.upper[2]; ++k)
        for (std::int32_t j = r.lower[1]; j <= r.upper[1]; ++j)
            for (std::int32_t i = r.lower[0]; i <= r.upper[0]; ++i) visit((static_cast<std::size_t>(k) * s.ny + j) * s.nx + i);
}

}  // namespace

FacetShapes CellGrid::shapes() const {
    return {{&surface, 1}, {triangles.data(), triangles.size()}, {cell_offsets.data(), cell_offsets.size()}, {cell_triangles.data(), cell_triangles.size()}, {}};
}

CellGrid make_cells(const TriangleMesh& mesh) {
    CellGrid g;
    Vec3d lower{1e300, 1e300, 1e300}, upper = -lower;
    for (const auto& corners : mesh.triangles) {
        Triangle t{mesh.vertices[corners[0]], mesh.vertices[corners[1]], mesh.vertices[corners[2]], {}, 0};
        t.normal = unit_normal(t.a, t.b, t.c);
        const Vec3d lo = least(t), hi = most(t);
        for (int a = 0; a < 3; ++a) {
            lower[a] = std::min(lower[a], lo[a]);
            upper[a] = std::max(upper[a], hi[a]);
        }
        g.triangles.push_back(t);
    }
    Surface& s = g.surface;
    s.count = static_cast<std::uint32_t>(g.triangles.size());
    s.lower = lower;
    Vec3d extent = upper - lower;
    const double longest = std::max({extent.x, extent.y, extent.z, 1e-30});
    for (int a = 0; a < 3; ++a) extent[a] = std::max(extent[a], longest * 1e-3);
    double edge = longest / std::sqrt(static_cast<double>(s.count));  // of a sheet with a cell a triangle
    for (divide(s, extent, edge); entries(s, g.triangles) > 16 * std::uint64_t{s.count} + 64 && s.nx * s.ny * s.nz > 1; divide(s, extent, edge)) edge *= 1.5;

    const std::size_t cells = static_cast<std::size_t>(s.nx) * s.ny * s.nz;
    g.cell_offsets.assign(cells + 1, 0);
    for (const Triangle& t : g.triangles) each_cell(s, range(s, t), [&](std::size_t c) { ++g.cell_offsets[c + 1]; });
    for (std::size_t c = 0; c < cells; ++c) g.cell_offsets[c + 1] += g.cell_offsets[c];
    g.cell_triangles.resize(g.cell_offsets[cells]);
    auto next = g.cell_offsets;
    for (std::uint32_t t = 0; t < s.count; ++t) each_cell(s, range(s, g.triangles[t]), [&](std::size_t c) { g.cell_triangles[next[c]++] = t; });
    return g;
}

}  // namespace grainray::surfaces
