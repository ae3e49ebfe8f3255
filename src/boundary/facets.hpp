// Surfaces made of triangles, as they lie on a device: meshes (triangles stored, found by a grid of cells) and terrain
// (triangles made from a grid of heights, found from the position). A facet is one triangle; facets of all surfaces are
// numbered through: meshes in the order of the scene, then the terrain.
#pragma once

#include "boundary/triangles.hpp"
#include "contacts/wrench.hpp"
#include "grainray/contacts.hpp"
#include "grainray/device.hpp"

namespace grainray {

/// What does not change while a surface moves. Its own frame is the one its triangles are given in.
struct Surface {
    std::uint32_t first = 0, count = 0;  ///< its facets
    bool terrain = false;
    Vec3d lower, width;                  ///< corner and edges of the cells; of a terrain, x and y of its nodes
    std::int32_t nx = 0, ny = 0, nz = 0; ///< cells; a terrain has one layer
    std::uint64_t start = 0;             ///< mesh: its first cell; terrain: its first height
};

/// Where a surface is in one step: a point b of its frame is at at + turn b, relative to the world's origin.
struct SurfaceNow {
    Vec3d turn[3];          ///< rows of the rotation
    Vec3d at, centre;
    Vec3f velocity, spin;   ///< m/s of `centre`, rad/s about it
    double reach_speed = 0; ///< bounds on the motion at any time, m/s and rad/s
    double reach_spin = 0;

    GR_HD Vec3d turned(const Vec3d& b) const { return {dot(turn[0], b), dot(turn[1], b), dot(turn[2], b)}; }
    GR_HD Vec3d turned_back(const Vec3d& x) const { return turn[0] * x.x + turn[1] * x.y + turn[2] * x.z; }
    GR_HD Vec3d into(const Vec3d& x) const { return turned_back(x - at); }
};

/// The memory of one particle with one facet. side: on which side of the facet the particle is (+1, -1; 0: not touching).
/// It is kept while they touch, so that a centre may dip below the surface as below a plane.
struct FacetState {
    Vec3f history;  ///< as for any contact, N, of the facet as if it were whole
    float side = 0;
};

/// Rows of facets for the particles near any; the others have no row.
struct FacetList {
    explicit FacetList(Device device)
        : row_of(device), particles(device), offsets(device), facets(device), states(device), shares(device), forces(device) {}
    Array<std::uint32_t> row_of;      ///< of each particle; ~0: none
    Array<std::uint32_t> particles;   ///< of each row, ascending
    Array<std::uint64_t> offsets;     ///< rows + 1
    Array<std::uint32_t> facets;      ///< ascending in each row
    Array<FacetState> states;
    Array<float> shares;              ///< scratch of a step
    Array<Wrench> forces;             ///< of each row in the present step, where the fused step adds them
    std::size_t rows() const { return particles.size(); }
    std::size_t bytes() const { return row_of.bytes() + forces.bytes() + particles.bytes() + offsets.bytes() + facets.bytes() + states.bytes() + shares.bytes(); }
};

/// Where the stage puts forces.
enum class FacetTarget { wrench, rows };

struct Facets {
    explicit Facets(Device device)
        : surfaces(device), triangles(device), cell_offsets(device), cell_triangles(device), heights(device), now(device), parameters(device),
          crossed(device), list(device), old_list(device) {}
    Array<Surface> surfaces;
    Array<Triangle> triangles;             ///< of the meshes
    Array<std::uint32_t> cell_offsets;     ///< cells of all meshes + 1
    Array<std::uint32_t> cell_triangles;   ///< a triangle stands in every cell its box meets
    Array<double> heights;                 ///< of the terrain's nodes, x runs fastest; NaN: a hole
    Array<SurfaceNow> now;                 ///< of the steps ahead, surface by surface
    Array<PairParameters> parameters;      ///< materials x surfaces
    Array<std::uint64_t> crossed;          ///< smallest (particle id, surface) that went through; ~0: none
    FacetList list, old_list;
    std::size_t count() const { return surfaces.size(); }
    std::size_t bytes() const {
        return surfaces.bytes() + triangles.bytes() + cell_offsets.bytes() + cell_triangles.bytes() + heights.bytes() + now.bytes() +
               parameters.bytes() + crossed.bytes() + list.bytes() + old_list.bytes();
    }
};

/// The shapes of all surfaces, as kernels and observers read them.
struct FacetShapes {
    View<const Surface> surfaces;
    View<const Triangle> triangles;
    View<const std::uint32_t> cell_offsets, cell_triangles;
    View<const double> heights;

    GR_HD double height(const Surface& s, std::int32_t i, std::int32_t j) const {
        return heights[s.start + static_cast<std::uint64_t>(j) * static_cast<std::uint64_t>(s.nx + 1) + static_cast<std::uint64_t>(i)];
    }
    GR_HD Vec3d node(const Surface& s, std::int32_t i, std::int32_t j) const {
        return {s.lower.x + i * s.width.x, s.lower.y + j * s.width.y, height(s, i, j)};
    }
    /// True where a node is outside the grid or a hole.
    GR_HD bool missing(const Surface& s, std::int32_t i, std::int32_t j) const {
        if (i < 0 || j < 0 || i > s.nx || j > s.ny) return true;
        const double h = height(s, i, j);
        return !(h == h);
    }
    /// Half of cell (i, j): 0 below its diagonal from (i, j) to (i + 1, j + 1), 1 above it.
    GR_HD Triangle half_cell(const Surface& s, std::int32_t i, std::int32_t j, int half) const {
        Triangle t;
        t.a = node(s, i, j);
        t.b = half ? node(s, i + 1, j + 1) : node(s, i + 1, j);
        t.c = half ? node(s, i, j + 1) : node(s, i + 1, j + 1);
        t.normal = unit_normal(t.a, t.b, t.c);
        return t;
    }
    GR_HD std::uint32_t half_cell_rims(const Surface& s, std::int32_t i, std::int32_t j, int half) const {
        const bool ab = half ? missing(s, i + 1, j) : missing(s, i, j - 1);
        const bool bc = half ? missing(s, i + 1, j + 2) : missing(s, i + 2, j + 1);
        const bool ca = half ? missing(s, i - 1, j) : missing(s, i, j + 1);
        return (ab ? 1u : 0u) | (bc ? 2u : 0u) | (ca ? 4u : 0u);
    }
    GR_HD bool has_half_cell(const Surface& s, std::int32_t i, std::int32_t j, int half) const {
        return !missing(s, i, j) && !missing(s, i + 1, j + 1) && !(half ? missing(s, i, j + 1) : missing(s, i + 1, j));
    }
    /// Of a terrain without its rims: they are asked for where an edge matters.
    GR_HD Triangle facet(const Surface& s, std::uint32_t id) const {
        if (!s.terrain) return triangles[id];
        const std::uint32_t cell = (id - s.first) / 2, nx = static_cast<std::uint32_t>(s.nx);
        return half_cell(s, static_cast<std::int32_t>(cell % nx), static_cast<std::int32_t>(cell / nx), static_cast<int>((id - s.first) & 1));
    }
    GR_HD std::uint32_t rims(const Surface& s, std::uint32_t id) const {
        if (!s.terrain) return triangles[id].free_edges;
        const std::uint32_t cell = (id - s.first) / 2, nx = static_cast<std::uint32_t>(s.nx);
        return half_cell_rims(s, static_cast<std::int32_t>(cell % nx), static_cast<std::int32_t>(cell / nx), static_cast<int>((id - s.first) & 1));
    }
    /// What a facet means to a sphere.
    GR_HD Section section_of(const Surface& s, std::uint32_t id, Triangle& t, const Vec3d& x, double radius) const {
        Section whole;
        whole.distance = dot(t.normal, x - t.a);
        const double square = (radius - whole.distance) * (radius + whole.distance);
        if (!(square > 0)) return whole;
        const int ab = beside_edge(t, 0, x, square), bc = beside_edge(t, 1, x, square), ca = beside_edge(t, 2, x, square);
        if (ab < 0 || bc < 0 || ca < 0) return whole;
        whole.share = 1;
        if (ab > 0 && bc > 0 && ca > 0) return whole;
        t.free_edges = rims(s, id);
        return section(t, x, radius);
    }

    /// True only where no point of a facet lies within `reach` of x; cheaper than the facet itself.
    GR_HD bool apart(const Surface& s, std::uint32_t id, const Vec3d& x, double reach) const {
        if (!s.terrain) return !within_reach(triangles[id], x, reach);
        const std::uint32_t cell = (id - s.first) / 2, nx = static_cast<std::uint32_t>(s.nx);
        const std::int32_t i = static_cast<std::int32_t>(cell % nx), j = static_cast<std::int32_t>(cell / nx);
        const bool half = (id - s.first) & 1;
        const double px = x.x - (s.lower.x + i * s.width.x), py = x.y - (s.lower.y + j * s.width.y), wide = 1.000001 * reach;
        if (px < -wide || px > s.width.x + wide || py < -wide || py > s.width.y + wide) return true;
        const double beyond = (py * s.width.x - px * s.width.y) * (half ? -1 : 1);  // the diagonal
        if (beyond > 0 && beyond * beyond > wide * wide * (s.width.x * s.width.x + s.width.y * s.width.y)) return true;
        const double corner = height(s, i, j), opposite = height(s, i + 1, j + 1), side = half ? height(s, i, j + 1) : height(s, i + 1, j);
        const double gx = (half ? opposite - side : side - corner) / s.width.x, gy = (half ? side - corner : opposite - side) / s.width.y;
        const double above = x.z - corner - gx * px - gy * py;
        return above * above > wide * wide * (1 + gx * gx + gy * gy);
    }
    /// Surface of a facet, searched from surface q on.
    GR_HD std::uint32_t surface_of(std::uint32_t id, std::uint32_t q) const {
        while (id >= surfaces[q].first + surfaces[q].count) ++q;
        return q;
    }

    GR_HD static std::int32_t cell(double x, double lower, double width, std::int32_t cells) {
        const double c = (x - lower) / width;
        return c < 0 ? 0 : c >= cells ? cells - 1 : static_cast<std::int32_t>(c);
    }
    /// visit(facet id) for every facet of a surface with a point within `reach` of x, and some more; each once.
    template <class Visit>
    GR_HD void for_each_near(std::uint32_t q, const Vec3d& x, double reach, const Visit& visit) const {
        const Surface& s = surfaces[q];
        const double top[3] = {s.nx * s.width.x, s.ny * s.width.y, s.nz * s.width.z};
        for (int a = 0; a < (s.terrain ? 2 : 3); ++a)
            if (x[a] + reach < s.lower[a] || x[a] - reach > s.lower[a] + top[a]) return;
        const std::int32_t x0 = cell(x.x - reach, s.lower.x, s.width.x, s.nx), x1 = cell(x.x + reach, s.lower.x, s.width.x, s.nx);
        const std::int32_t y0 = cell(x.y - reach, s.lower.y, s.width.y, s.ny), y1 = cell(x.y + reach, s.lower.y, s.width.y, s.ny);
        if (s.terrain) {
            for (std::int32_t j = y0; j <= y1; ++j)
                for (std::int32_t i = x0; i <= x1; ++i)
                    for (int half = 0; half < 2; ++half)
                        if (has_half_cell(s, i, j, half) && within_reach(half_cell(s, i, j, half), x, reach))
                            visit(s.first + 2 * (static_cast<std::uint32_t>(j) * static_cast<std::uint32_t>(s.nx) + static_cast<std::uint32_t>(i)) + static_cast<std::uint32_t>(half));
            return;
        }
        const std::int32_t z0 = cell(x.z - reach, s.lower.z, s.width.z, s.nz), z1 = cell(x.z + reach, s.lower.z, s.width.z, s.nz);
        for (std::int32_t k = z0; k <= z1; ++k)
            for (std::int32_t j = y0; j <= y1; ++j)
                for (std::int32_t i = x0; i <= x1; ++i) visit_cell(s, x, reach, i, j, k, x0, y0, z0, visit);
    }
    /// A triangle that stands in several cells is visited in the first of them that the query meets.
    template <class Visit>
    GR_HD void visit_cell(const Surface& s, const Vec3d& x, double reach, std::int32_t i, std::int32_t j, std::int32_t k, std::int32_t x0,
                          std::int32_t y0, std::int32_t z0, const Visit& visit) const {
        const std::uint64_t c = s.start + static_cast<std::uint64_t>((static_cast<std::int64_t>(k) * s.ny + j) * s.nx + i);
        for (std::uint32_t e = cell_offsets[c]; e < cell_offsets[c + 1]; ++e) {
            const std::uint32_t id = cell_triangles[e];
            const Triangle& t = triangles[id];
            const auto least = [&](double a, double b, double d) { return a < b ? (a < d ? a : d) : (b < d ? b : d); };
            const std::int32_t tx = cell(least(t.a.x, t.b.x, t.c.x), s.lower.x, s.width.x, s.nx),
                               ty = cell(least(t.a.y, t.b.y, t.c.y), s.lower.y, s.width.y, s.ny),
                               tz = cell(least(t.a.z, t.b.z, t.c.z), s.lower.z, s.width.z, s.nz);
            if (i == (tx > x0 ? tx : x0) && j == (ty > y0 ? ty : y0) && k == (tz > z0 ? tz : z0) && within_reach(t, x, reach)) visit(id);
        }
    }
};

/// Views of host vectors and device arrays alike.
inline FacetShapes shapes_of(const Facets& f) {
    return {f.surfaces.view(), f.triangles.view(), f.cell_offsets.view(), f.cell_triangles.view(), f.heights.view()};
}

}  // namespace grainray
