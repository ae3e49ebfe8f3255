#include "boundary/build.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "surfaces/surfaces.hpp"

namespace grainray {
namespace {

struct Parts {
    std::vector<Surface> surfaces;
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> cell_offsets{0}, cell_triangles;
    std::vector<double> heights;
    std::uint64_t facets = 0;

    void count(std::uint64_t more) {
        facets += more;
        if (facets >= std::numeric_limits<std::uint32_t>::max())
            throw InputError(fmt::format("the meshes and the terrain have {} triangles together; at most 4294967294 can be numbered", facets));
    }

    void add_mesh(const TriangleMesh& mesh) {
        surfaces::CellGrid g = surfaces::make_cells(mesh);
        surfaces::find_rims(g);
        Surface& s = g.surface;
        s.first = static_cast<std::uint32_t>(facets);
        s.start = cell_offsets.size() - 1;
        count(s.count);
        const std::uint32_t base = cell_offsets.back();
        for (std::size_t c = 1; c < g.cell_offsets.size(); ++c) cell_offsets.push_back(base + g.cell_offsets[c]);
        for (const std::uint32_t t : g.cell_triangles) cell_triangles.push_back(s.first + t);
        triangles.insert(triangles.end(), g.triangles.begin(), g.triangles.end());
        surfaces.push_back(s);
    }

    /// Heights are rounded to position units, so that a shifted world has the same ones.
    void add_terrain(const ElevationGrid& g, const PositionScale& scale) {
        Surface s;
        s.terrain = true;
        s.first = static_cast<std::uint32_t>(facets);
        s.nx = static_cast<std::int32_t>(g.columns - 1);
        s.ny = static_cast<std::int32_t>(g.rows - 1);
        s.nz = 1;
        const std::uint64_t cells = static_cast<std::uint64_t>(s.nx) * static_cast<std::uint64_t>(s.ny);
        count(2 * cells);
        s.count = static_cast<std::uint32_t>(2 * cells);
        s.lower = {g.x - scale.origin.x, g.y - scale.origin.y, 0};
        s.width = {g.dx, g.dy, 1};
        for (const double h : g.heights) heights.push_back(std::isnan(h) ? h : std::nearbyint((h - scale.origin.z) / scale.unit) * scale.unit);
        surfaces.push_back(s);
    }
};

/// A mesh keeps its own frame, the file's after scaling and turning; it is placed relative to the world's origin.
SurfaceNow mesh_at(const Mesh& mesh, const PositionScale& scale, double time) {
    const MotionState m = motion_at(mesh.motion, time);
    const Vec3d point = mesh.motion.rotation_point - scale.origin, placed = mesh.translation - scale.origin, axis = mesh.motion.rotation_axis;
    SurfaceNow now;
    const Vec3d units[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int a = 0; a < 3; ++a) {
        const Vec3d column = m.angle != 0 ? turned(units[a], axis, m.angle) : units[a];
        for (int row = 0; row < 3; ++row) now.turn[row][a] = column[row];
    }
    now.centre = point + m.shift;
    now.at = m.angle != 0 ? now.centre + turned(placed - point, axis, m.angle) : placed + m.shift;
    now.velocity = convert<float>(m.velocity);
    now.spin = convert<float>(m.angular_velocity);
    now.reach_speed = greatest_speed(mesh.motion);
    now.reach_spin = std::fabs(mesh.motion.rotation_rate);
    return now;
}

}  // namespace

void build_facets(const Scene& scene, const PositionScale& scale, Facets& f) {
    Parts parts;
    for (const Mesh& mesh : scene.meshes) parts.add_mesh(load_mesh(scene, mesh));
    if (scene.terrain) parts.add_terrain(load_ground(scene), scale);
    f.surfaces.assign(parts.surfaces);
    f.triangles.assign(parts.triangles);
    f.cell_offsets.assign(parts.cell_offsets);
    f.cell_triangles.assign(parts.cell_triangles);
    f.heights.assign(parts.heights);
    f.crossed.assign(std::vector{~std::uint64_t{0}});
}

void place_facets(const Scene& scene, const PositionScale& scale, std::uint64_t step, std::uint32_t count, Facets& f) {
    if (f.count() == 0) return;
    std::vector<SurfaceNow> now;
    for (std::uint32_t k = 0; k < count; ++k) {
        for (const Mesh& mesh : scene.meshes) now.push_back(mesh_at(mesh, scale, static_cast<double>(step + k) * scene.dt));
        if (scene.terrain) now.push_back(mesh_at({}, {scale.unit, {}}, 0));
    }
    f.now.assign(now);
}

bool facets_move(const Scene& scene) {
    for (const Mesh& mesh : scene.meshes)
        if (mesh.motion.moves()) return true;
    return false;
}

std::optional<Box> open_terrain(const Scene& scene, const Facets& f) {
    if (!scene.terrain || scene.terrain->edge != TerrainEdge::open) return {};
    const std::vector<Surface> surfaces = f.surfaces.to_host();
    const Surface& s = surfaces.back();
    double lowest = std::numeric_limits<double>::infinity();
    for (const double h : f.heights.to_host()) lowest = h < lowest ? h : lowest;
    return Box{{s.lower.x, s.lower.y, lowest}, {s.lower.x + s.nx * s.width.x, s.lower.y + s.ny * s.width.y, 0}};
}

}  // namespace grainray
