// Geometry of boundaries on the host: reading files, cleaning meshes, finding triangles by place.
#pragma once

#include <filesystem>
#include <string>

#include "boundary/facets.hpp"
#include "grainray/scene.hpp"

namespace grainray::surfaces {

/// "scene.toml: key 'meshes.NAME.file' = ..." for errors found when the file is read.
std::string place_of(const Scene&, const std::string& key, const std::filesystem::path& value);
/// Where a path of the scene leads.
std::filesystem::path resolve(const Scene&, const std::filesystem::path&);

/// As load_mesh, for the file that the scene names under `key`.
TriangleMesh load_surface(const Scene&, const Mesh&, const std::string& key, MeshReport*);
/// Triangles as the file has them. Throws InputError that begins with `place`.
TriangleMesh read_mesh_file(const std::filesystem::path&, const std::string& place);
/// Throws InputError that begins with `place`.
ElevationGrid read_grid_file(const std::filesystem::path&, const std::string& place);
/// Writes an ESRI ASCII grid; holes become -9999. Throws SimulationError.
void write_esri_grid(const std::filesystem::path&, const ElevationGrid&);

/// Merges equal corners, leaves out triangles without area and duplicates, turns triangles over where their neighbours face
/// the other way.
TriangleMesh clean(TriangleMesh, MeshReport&);

/// Triangles with their normals, and the cells they stand in.
struct CellGrid {
    Surface surface;                            ///< first and start are 0
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> cell_offsets, cell_triangles;
    FacetShapes shapes() const;
};
CellGrid make_cells(const TriangleMesh&);
/// An edge is a rim where no other triangle lies along it; corners of others on it (T-junctions) count as lying along.
void find_rims(CellGrid&);

}  // namespace grainray::surfaces
