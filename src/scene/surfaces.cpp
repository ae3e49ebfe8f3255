// [meshes.NAME] -> Mesh, [terrain] -> Terrain. Their files are read later: src/surfaces/.
#include <fmt/format.h>

#include "scene/read.hpp"

namespace grainray::scene {
namespace {

/// Surfaces do not repeat themselves along periodic axes.
void refuse_periodic(const Node& table, const Scene& s) {
    for (int axis = 0; axis < 3; ++axis)
        if (s.domain.periodic[static_cast<std::size_t>(axis)])
            fail(table, fmt::format("meshes and terrain do not go on across a periodic axis, and axis {} is one; close it in domain.periodic", "xyz"[axis]));
}

}  // namespace

Mesh read_mesh(const Node& table, const std::string& name, const Scene& s) {
    Mesh mesh;
    MeshRow row;
    std::vector<std::string_view> known{"motion"};
    append_keys(known, schema().mesh_file);
    append_keys(known, schema().mesh);
    check_keys(table, std::move(known));
    read_fields(table, schema().mesh_file, row);
    read_fields(table, schema().mesh, mesh);
    mesh.name = name;
    mesh.file = row.file;
    check_material(table.child("material"), mesh.material, s);
    refuse_periodic(table, s);
    mesh.motion = read_motion(table, s);
    return mesh;
}

Terrain read_terrain(const Node& table, const Scene& s) {
    Terrain terrain;
    TerrainRow row;
    std::vector<std::string_view> known;
    append_keys(known, schema().terrain_files);
    append_keys(known, schema().terrain);
    check_keys(table, std::move(known));
    read_fields(table, schema().terrain_files, row);
    read_fields(table, schema().terrain, terrain);
    terrain.after_file = row.after;
    if (row.before) terrain.before_file = *row.before;
    check_material(table.child("material"), terrain.material, s);
    refuse_periodic(table, s);
    return terrain;
}

}  // namespace grainray::scene
