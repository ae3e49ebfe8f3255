// Grids of elevations: heights between nodes, refinement.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "surfaces/surfaces.hpp"

namespace grainray {

bool ElevationGrid::same_nodes(const ElevationGrid& o) const {
    const auto near = [](double a, double b, double scale) { return std::fabs(a - b) <= 1e-6 * scale; };
    return columns == o.columns && rows == o.rows && near(dx, o.dx, dx) && near(dy, o.dy, dy) && near(x, o.x, dx) && near(y, o.y, dy);
}

double ElevationGrid::height(double px, double py) const {
    const double u = (px - x) / dx, v = (py - y) / dy;
    if (!(u >= 0 && v >= 0 && u <= static_cast<double>(columns - 1) && v <= static_cast<double>(rows - 1))) return NAN;
    const auto i = std::min(static_cast<std::int64_t>(u), columns - 2), j = std::min(static_cast<std::int64_t>(v), rows - 2);
    const double s = u - static_cast<double>(i), t = v - static_cast<double>(j);
    const double corner = at(i, j), opposite = at(i + 1, j + 1);
    if (s >= t) return corner + s * (at(i + 1, j) - corner) + t * (opposite - at(i + 1, j));
    return corner + t * (at(i, j + 1) - corner) + s * (opposite - at(i, j + 1));
}

Vec3d ElevationGrid::slope(double px, double py) const {
    const double u = std::clamp((px - x) / dx, 0.0, static_cast<double>(columns - 1)), v = std::clamp((py - y) / dy, 0.0, static_cast<double>(rows - 1));
    const auto i = std::min(static_cast<std::int64_t>(u), columns - 2), j = std::min(static_cast<std::int64_t>(v), rows - 2);
    const bool lower = u - static_cast<double>(i) >= v - static_cast<double>(j);
    const double gx = (lower ? at(i + 1, j) - at(i, j) : at(i + 1, j + 1) - at(i, j + 1)) / dx;
    const double gy = (lower ? at(i + 1, j + 1) - at(i + 1, j) : at(i, j + 1) - at(i, j)) / dy;
    return {gx, gy, 0};
}

double ElevationGrid::steepness(double px, double py) const {
    const Vec3d g = slope(px, py);
    return std::sqrt(1 + dot(g, g));
}

namespace {

double catmull_rom(double a, double b, double c, double d, double t) {
    return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

/// Heights along one line, between its nodes too. Past the ends and holes the line goes on straight; next to a hole inside
/// a cell there is nothing.
std::vector<double> refined_line(const std::vector<double>& h, std::int64_t factor) {
    const auto n = static_cast<std::int64_t>(h.size());
    std::vector<double> out(static_cast<std::size_t>((n - 1) * factor + 1), NAN);
    const auto at = [&](std::int64_t k) { return k < 0 || k >= n ? NAN : h[static_cast<std::size_t>(k)]; };
    for (std::int64_t k = 0; k < n; ++k) {
        out[static_cast<std::size_t>(k * factor)] = at(k);
        const double b = at(k), c = at(k + 1);
        if (std::isnan(b) || std::isnan(c)) continue;
        const double a = std::isnan(at(k - 1)) ? 2 * b - c : at(k - 1), d = std::isnan(at(k + 2)) ? 2 * c - b : at(k + 2);
        for (std::int64_t f = 1; f < factor; ++f)
            out[static_cast<std::size_t>(k * factor + f)] = catmull_rom(a, b, c, d, static_cast<double>(f) / static_cast<double>(factor));
    }
    return out;
}

}  // namespace

ElevationGrid ElevationGrid::refined(std::int64_t factor) const {
    if (factor <= 1) return *this;
    ElevationGrid fine{(columns - 1) * factor + 1, (rows - 1) * factor + 1, x, y, dx / static_cast<double>(factor), dy / static_cast<double>(factor), {}};
    std::vector<std::vector<double>> lines;
    for (std::int64_t j = 0; j < rows; ++j)
        lines.push_back(refined_line({heights.begin() + j * columns, heights.begin() + (j + 1) * columns}, factor));
    fine.heights.assign(static_cast<std::size_t>(fine.columns * fine.rows), NAN);
    for (std::int64_t i = 0; i < fine.columns; ++i) {
        std::vector<double> column;
        for (const auto& line : lines) column.push_back(line[static_cast<std::size_t>(i)]);
        column = refined_line(column, factor);
        for (std::int64_t j = 0; j < fine.rows; ++j) fine.heights[static_cast<std::size_t>(j * fine.columns + i)] = column[static_cast<std::size_t>(j)];
    }
    return fine;
}

namespace surfaces {

std::filesystem::path resolve(const Scene& scene, const std::filesystem::path& path) {
    return path.is_absolute() ? path : scene.file.parent_path() / path;
}

std::string place_of(const Scene& scene, const std::string& key, const std::filesystem::path& value) {
    return fmt::format("{}: key '{}' = \"{}\": ", scene.file.empty() ? "scene" : scene.file.string(), key, value.string());
}

namespace {

ElevationGrid read_ground(const Scene& scene) {
    const Terrain& t = scene.terrain.value();
    return t.after ? *t.after : read_grid_file(resolve(scene, t.after_file), place_of(scene, "terrain.after", t.after_file));
}

}  // namespace
}  // namespace surfaces

ElevationGrid load_ground(const Scene& scene) { return surfaces::read_ground(scene).refined(scene.terrain->smooth); }

ElevationGrid load_surface_before(const Scene& scene) {
    const Terrain& t = scene.terrain.value();
    const std::string place = surfaces::place_of(scene, "terrain.before", t.before_file);
    const ElevationGrid before = t.before ? *t.before : surfaces::read_grid_file(surfaces::resolve(scene, t.before_file), place);
    const ElevationGrid after = surfaces::read_ground(scene);
    if (before.dx != after.dx || before.dy != after.dy)
        throw InputError(fmt::format("{}its cells are {} x {} m and those of terrain.after {} x {} m; resample one of them, so that both have the same nodes", place,
                                     before.dx, before.dy, after.dx, after.dy));
    if (!before.same_nodes(after))
        throw InputError(fmt::format("{}it has {} x {} nodes from ({}, {}) and terrain.after {} x {} from ({}, {}); cut both to the same nodes", place, before.columns,
                                     before.rows, before.x, before.y, after.columns, after.rows, after.x, after.y));
    return before.refined(t.smooth);
}

TriangleMesh load_mesh(const Scene& scene, const Mesh& mesh, MeshReport* report) {
    return surfaces::load_surface(scene, mesh, "meshes." + mesh.name + ".file", report);
}

TriangleMesh surfaces::load_surface(const Scene& scene, const Mesh& mesh, const std::string& key, MeshReport* report) {
    const std::string place = surfaces::place_of(scene, key, mesh.file);
    TriangleMesh m = mesh.geometry ? *mesh.geometry : surfaces::read_mesh_file(surfaces::resolve(scene, mesh.file), place);
    for (Vec3d& v : m.vertices) {
        v *= mesh.scale;
        const Vec3d axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        for (int a = 0; a < 3; ++a)
            if (mesh.rotation[a] != 0) v = turned(v, axes[a], mesh.rotation[a]);
    }
    MeshReport unused;
    m = surfaces::clean(std::move(m), report ? *report : unused);
    if (m.triangles.empty()) throw InputError(place + "it holds no triangle with an area; give a file with a closed or open surface of triangles");
    return m;
}

}  // namespace grainray
