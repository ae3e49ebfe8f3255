// What is wrong with a mesh, and what can be put right: equal corners, triangles without area, duplicates, triangles that
// face the other way than their neighbours; and which edges are rims.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <unordered_map>

#include "surfaces/surfaces.hpp"

namespace grainray::surfaces {
namespace {

constexpr double flat_sliver = 1e-3;     // height over longest edge
constexpr double no_area = 1e-12;        // the same: nothing to stand on
constexpr double lies_on_edge = 1e-4;    // distance over length of the edge

struct VertexHash {
    std::size_t operator()(const Vec3d& v) const {
        std::uint64_t h = 0;
        for (int a = 0; a < 3; ++a) {
            std::uint64_t bits;
            const double x = v[a] + 0.0;  // -0 and 0 are one place
            std::memcpy(&bits, &x, sizeof bits);
            h = (h ^ bits) * 0x9e3779b97f4a7c15;
            h ^= h >> 32;
        }
        return h;
    }
};

void merge_corners(TriangleMesh& m) {
    std::unordered_map<Vec3d, std::uint32_t, VertexHash> known;
    std::vector<std::uint32_t> to(m.vertices.size());
    std::vector<Vec3d> merged;
    for (std::size_t v = 0; v < m.vertices.size(); ++v) {
        const auto [place, fresh] = known.emplace(m.vertices[v], static_cast<std::uint32_t>(merged.size()));
        if (fresh) merged.push_back(m.vertices[v]);
        to[v] = place->second;
    }
    for (auto& t : m.triangles)
        for (auto& corner : t) corner = to[corner];
    m.vertices = std::move(merged);
}

struct Shape {
    double longest, height, area;
};
Shape shape_of(const TriangleMesh& m, const std::array<std::uint32_t, 3>& t) {
    const Vec3d a = m.vertices[t[0]], b = m.vertices[t[1]], c = m.vertices[t[2]];
    const double longest = std::max({length(b - a), length(c - b), length(a - c)}), twice = length(cross(b - a, c - a));
    return {longest, longest > 0 ? twice / longest : 0, 0.5 * twice};
}

void drop_useless(TriangleMesh& m, MeshReport& report) {
    std::set<std::array<std::uint32_t, 3>> seen;
    std::vector<std::array<std::uint32_t, 3>> kept;
    for (const auto& t : m.triangles) {
        const Shape shape = shape_of(m, t);
        auto key = t;
        std::sort(key.begin(), key.end());
        if (!(shape.height > no_area * shape.longest)) ++report.degenerate;
        else if (!seen.insert(key).second) ++report.duplicates;
        else {
            report.slivers += shape.height < flat_sliver * shape.longest;
            report.area += shape.area;
            kept.push_back(t);
        }
    }
    m.triangles = std::move(kept);
}

/// Triangles along each edge.
using Edges = std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>>;
Edges edges_of(const TriangleMesh& m) {
    Edges edges;
    for (std::uint32_t t = 0; t < m.triangles.size(); ++t)
        for (int e = 0; e < 3; ++e) edges[std::minmax(m.triangles[t][e], m.triangles[t][(e + 1) % 3])].push_back(t);
    return edges;
}

bool runs(const std::array<std::uint32_t, 3>& t, std::uint32_t from, std::uint32_t to) {
    return (t[0] == from && t[1] == to) || (t[1] == from && t[2] == to) || (t[2] == from && t[0] == to);
}

/// Two neighbours face the same way where they run along their edge in opposite directions. Spreads from the first triangle
/// of each piece; the lesser half of a piece is the one that is turned over.
void face_alike(TriangleMesh& m, const Edges& edges, MeshReport& report) {
    std::vector<std::vector<std::pair<std::uint32_t, bool>>> neighbors(m.triangles.size());  // and whether they disagree
    for (const auto& [edge, sides] : edges) {
        report.free_edges += sides.size() == 1;
        report.crowded_edges += sides.size() > 2;
        if (sides.size() != 2) continue;
        const bool clash = runs(m.triangles[sides[0]], edge.first, edge.second) == runs(m.triangles[sides[1]], edge.first, edge.second);
        neighbors[sides[0]].emplace_back(sides[1], clash);
        neighbors[sides[1]].emplace_back(sides[0], clash);
    }
    std::vector<int> turned(m.triangles.size(), -1);
    for (std::uint32_t start = 0; start < m.triangles.size(); ++start) {
        if (turned[start] >= 0) continue;
        ++report.parts;
        std::vector<std::uint32_t> piece{start};
        turned[start] = 0;
        for (std::size_t k = 0; k < piece.size(); ++k)
            for (const auto& [next, clash] : neighbors[piece[k]])
                if (turned[next] < 0) turned[next] = turned[piece[k]] ^ static_cast<int>(clash), piece.push_back(next);
        const auto count = static_cast<std::size_t>(std::count_if(piece.begin(), piece.end(), [&](auto t) { return turned[t] == 1; }));
        const int lesser = 2 * count > piece.size() ? 0 : 1;
        for (const std::uint32_t t : piece)
            if (turned[t] == lesser) std::swap(m.triangles[t][1], m.triangles[t][2]), ++report.reversed;
    }
}

}  // namespace

TriangleMesh clean(TriangleMesh m, MeshReport& report) {
    report = {};
    merge_corners(m);
    drop_useless(m, report);
    face_alike(m, edges_of(m), report);
    report.triangles = m.triangles.size();
    report.vertices = m.vertices.size();
    if (!m.vertices.empty()) report.bounds = {m.vertices[0], m.vertices[0]};
    for (const Vec3d& v : m.vertices)
        for (int a = 0; a < 3; ++a) {
            report.bounds.lower[a] = std::min(report.bounds.lower[a], v[a]);
            report.bounds.upper[a] = std::max(report.bounds.upper[a], v[a]);
        }
    return m;
}

void find_rims(CellGrid& g) {
    const FacetShapes shapes = g.shapes();
    for (std::uint32_t t = 0; t < g.triangles.size(); ++t)
        for (int e = 0; e < 3; ++e) {
            const Vec3d from = g.triangles[t].corner(e), along = g.triangles[t].corner((e + 1) % 3) - from;
            const double near = lies_on_edge * length(along);
            bool alone = true;
            for (const double part : {1.0 / 6, 0.5, 5.0 / 6})
                shapes.for_each_near(0, from + along * part, near, [&](std::uint32_t other) { alone = alone && other == t; });
            if (alone) g.triangles[t].free_edges |= 1u << e;
        }
}

}  // namespace grainray::surfaces
