// TOML text -> Scene. Read parse_scene first.
#include "grainray/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>
#include <system_error>

#include "scene/read.hpp"

namespace grainray {
namespace scene {
namespace {

void read_simulation(const Node& root, Scene& s) {
    const Node table = root.child("simulation");
    read_table(table, schema().simulation, s);
    if (s.duration / s.dt > 1e15)
        fail_key(table, "dt",
                 fmt::format("makes {:.3g} steps of {} s; at most 1e15 steps can be counted", s.duration / s.dt,
                             s.duration));
}

void read_domain(const Node& root, Scene& s) {
    const Node table = root.child("domain");
    DomainRow row;
    read_table(table, schema().domain, row);
    s.domain.periodic = row.periodic;
    if (row.lower.has_value() != row.upper.has_value())
        fail_key(table, row.lower ? "lower" : "upper",
                 fmt::format("a box needs both corners; add '{}'", row.lower ? "upper" : "lower"));
    if (!row.lower) {
        for (int axis = 0; axis < 3; ++axis)
            if (row.periodic[static_cast<std::size_t>(axis)])
                fail_key(table, "periodic",
                         fmt::format("axis {} is periodic, so the domain needs 'lower' and 'upper'", "xyz"[axis]));
        return;
    }
    for (int axis = 0; axis < 3; ++axis)
        if (!((*row.upper)[axis] > (*row.lower)[axis]))
            fail_key(table, "upper",
                     fmt::format("must be greater than 'lower' along {} ({} m)", "xyz"[axis], (*row.lower)[axis]));
    s.domain.box = Box{*row.lower, *row.upper};
}

void read_render(const Node& root, Scene& s) {
    const Node table = root.child("render"), camera = table.child("camera");
    RenderSettings& r = s.render;
    read_table(table, schema().render, r, {"camera"});
    if (r.color_minimum && r.color_maximum && !(*r.color_maximum > *r.color_minimum))
        fail_key(table, "color_maximum", fmt::format("must be greater than color_minimum ({})", *r.color_minimum));
    read_table(camera, schema().camera, r.camera);
    r.camera.up = unit_vector(camera, "up", r.camera.up);
    if (r.camera.eye && r.camera.target && *r.camera.eye == *r.camera.target)
        fail_key(camera, "target", "must differ from 'eye'");
}

/// The named tables below `key`, in the order written.
std::vector<std::pair<std::string, Node>> named_tables(const Node& root, std::string_view key) {
    const Node parent = root.child(key);
    if (!parent.value->table())
        fail(parent, fmt::format("expected tables [{}.NAME], found {}", key, parent.value->type()));
    std::vector<std::pair<std::string, Node>> result;
    for (const Entry& e : *parent.value->table()) {
        const Node node = parent.child(e.key);
        if (!node.value->table())
            fail(node, fmt::format("expected a table [{}.NAME], found {}", key, node.value->type()));
        result.emplace_back(e.key, node);
    }
    return result;
}

void read_materials(const Node& root, Scene& s) {
    for (const auto& [name, node] : named_tables(root, "materials")) {
        Material material;
        material.name = name;
        read_table(node, schema().material, material);
        s.materials.push_back(std::move(material));
    }
}

void read_pairs(const Node& root, Scene& s) {
    if (!root.has("pairs")) return;
    const Node parent = root.child("pairs");
    if (!parent.value->list()) fail(parent, fmt::format("expected rows [[pairs]], found {}", parent.value->type()));
    std::set<std::pair<std::string, std::string>> seen;
    for (const Node& node : elements(parent, 0, "tables")) {
        PairRow row;
        if (!node.value->table()) fail(node, fmt::format("expected a row [[pairs]], found {}", node.value->type()));
        read_table(node, schema().pair, row);
        const auto& [a, b] = row.materials;
        for (const auto& name : row.materials) check_material(node.child("materials"), name, s);
        if (!seen.insert(std::minmax(a, b)).second)
            fail_key(node, "materials", fmt::format("'{}' with '{}' has a row already; give each pair one row", a, b));
        s.pairs.push_back(std::move(row));
    }
}

/// Everything a scene may hold at the top.
void check_top(const Node& root) {
    std::vector<std::string_view> known{"simulation", "domain",    "contact", "search",    "output", "limits",
                                        "render",     "materials", "pairs",   "particles", "planes", "meshes", "terrain",
                                        "streams",    "removals"};
    append_keys(known, schema().top);
    check_keys(root, std::move(known));
}

/// Upright planes at the outermost nodes, after all others, so that the numbers of those stay.
void wall_terrain(Scene& s) {
    const ElevationGrid g = load_ground(s);
    const double east = g.x + g.dx * static_cast<double>(g.columns - 1), north = g.y + g.dy * static_cast<double>(g.rows - 1);
    const std::string& material = s.terrain->material;
    s.planes.push_back({"terrain west", material, {g.x, g.y, 0}, {1, 0, 0}, {}});
    s.planes.push_back({"terrain east", material, {east, g.y, 0}, {-1, 0, 0}, {}});
    s.planes.push_back({"terrain south", material, {g.x, g.y, 0}, {0, 1, 0}, {}});
    s.planes.push_back({"terrain north", material, {g.x, north, 0}, {0, -1, 0}, {}});
}

Scene read_scene(const Node& root, const std::filesystem::path& file) {
    Scene s;
    s.file = file;  // relative paths start there
    check_top(root);
    read_fields(root, schema().top, s);
    read_simulation(root, s);
    read_domain(root, s);
    read_table(root.child("contact"), schema().contact, s.contact);
    read_table(root.child("search"), schema().search, s.search, {"rays"});
    read_table(root.child("search").child("rays"), schema().rays, s.search.rays);
    read_table(root.child("output"), schema().output, s.output);
    read_table(root.child("limits"), schema().limits, s.limits);
    read_render(root, s);
    read_materials(root, s);
    read_pairs(root, s);
    if (root.has("terrain")) s.terrain = read_terrain(root.child("terrain"), s);
    for (const auto& [name, node] : named_tables(root, "particles")) s.particles.push_back(read_group(node, name, s));
    for (const auto& [name, node] : named_tables(root, "planes")) s.planes.push_back(read_plane(node, name, s));
    for (const auto& [name, node] : named_tables(root, "meshes")) s.meshes.push_back(read_mesh(node, name, s));
    for (const auto& [name, node] : named_tables(root, "streams")) s.streams.push_back(read_stream(node, name, s));
    for (const auto& [name, node] : named_tables(root, "removals")) s.removals.push_back(read_removal(node, name, s));
    if (s.terrain && s.terrain->edge == TerrainEdge::walled) wall_terrain(s);
    return s;
}

}  // namespace

void fail_key(const Node& table, std::string_view key, const std::string& why) {
    if (table.has(key)) fail(table.child(key), why);
    throw InputError(fmt::format("{}: key '{}': {}", table.place.text(), table.key_of(key), why));
}

Vec3d unit_vector(const Node& table, std::string_view key, const Vec3d& v) {
    const double scale = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});  // against overflow of the square
    if (!(scale > 0)) fail_key(table, key, "must not be the zero vector (a typical value is [0, 0, 1])");
    const Vec3d scaled = v * (1 / scale);
    return scaled * (1 / length(scaled));
}

void check_material(const Node& where, const std::string& name, const Scene& s) {
    std::vector<std::string_view> known;
    for (const Material& m : s.materials) known.push_back(m.name);
    if (std::find(known.begin(), known.end(), name) != known.end()) return;
    if (known.empty())
        fail(where, fmt::format("unknown material '{}': the scene has none; add a table [materials.{}]", name, name));
    fail(where, fmt::format("unknown material '{}'{} Defined: {}", name, did_you_mean(name, known), join(known)));
}

}  // namespace scene

Scene parse_scene(const std::string& text, const std::string& name, const std::vector<std::string>& overrides) {
    scene::Value document = scene::parse_document(text, name);
    for (const std::string& setting : overrides) scene::apply_override(document, setting);
    Scene result = scene::read_scene({&document, document.place, ""}, name);
    result.source = text;
    if (!overrides.empty() && !text.empty() && text.back() != '\n') result.source += '\n';
    for (const std::string& setting : overrides) result.source += "# --set " + setting + '\n';
    return result;
}

Scene load_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    std::error_code error;
    if (std::filesystem::is_directory(file, error))
        throw InputError(fmt::format("{}: is a directory; give the scene file in it", file.string()));
    std::ifstream in(file, std::ios::binary);
    if (!in)
        throw InputError(fmt::format("{}: cannot be read: {}", file.string(), std::generic_category().message(errno)));
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    return parse_scene(text, file.string(), overrides);
}

}  // namespace grainray
