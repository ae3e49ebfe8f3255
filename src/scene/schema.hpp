// THE field table: every key a scene may have, with its unit, default, range and meaning (schema.cpp).
#pragma once

#include "grainray/scene.hpp"
#include "scene/field.hpp"

namespace grainray::scene {

// Rows for tables of the file that are laid out differently from the struct they end in.
struct DomainRow {
    std::optional<Vec3d> lower, upper;
    std::array<bool, 3> periodic{};
};
enum class Placement { lattice, list, file, fill, release };
struct PlacementRow {
    Placement type = Placement::lattice;
};
struct FileRow {
    std::string path;
};
struct PathRow {
    std::optional<std::string> path;
};
struct MeshRow {
    std::string file;
};
struct TerrainRow {
    std::string after;
    std::optional<std::string> before;
};
struct ReleaseRow {
    std::optional<double> spacing, radius, thickness;
    std::optional<std::int64_t> count;
    double jitter = 0;
    std::optional<std::string> polygon;
};
struct FillRow {
    Vec3d lower, upper;
    std::optional<std::int64_t> count;
    std::optional<double> solid_fraction;
};
enum class Inlet { box, surface };
struct InletRow {
    Inlet type = Inlet::box;
};
struct InletBoxRow {
    Vec3d lower, upper;
};
struct InletSurfaceRow {
    std::optional<std::string> mesh, file;
    double depth = 0;
    std::optional<Vec3d> lower, upper;
};
struct RemovalBoxRow {
    Vec3d lower, upper;
};
/// Cut-offs are optional: three deviations where they are not given.
struct SizeRow {
    SizeLaw law = SizeLaw::fixed;
    double radius = 0, mean = 0, deviation = 0;
    std::optional<double> minimum, maximum;
    std::vector<double> radii, weights;
};

struct Schema {
    Section<Scene> top, simulation;
    Section<DomainRow> domain;
    Section<ContactSettings> contact;
    Section<SearchSettings> search;
    Section<RaySettings> rays;
    Section<OutputSettings> output;
    Section<Limits> limits;
    Section<RenderSettings> render;
    Section<Camera> camera;
    Section<Material> material;
    Section<PairRow> pair;
    Section<PlacementRow> placement;
    Section<ParticleGroup> group;
    Section<Lattice> lattice;
    Section<ParticleList> list;
    Section<FileRow> file;
    Section<FillRow> fill;
    Section<ReleaseRow> release;
    Section<SizeRow> size;                      ///< the law alone
    std::array<Section<SizeRow>, 5> size_laws;  ///< the fields of each law, in the order of SizeLaw
    Section<Plane> plane;
    Section<MeshRow> mesh_file;
    Section<Mesh> mesh;
    Section<TerrainRow> terrain_files;
    Section<Terrain> terrain;
    Section<InletRow> inlet;
    Section<ParticleStream> stream;
    Section<InletBoxRow> inlet_box;
    Section<InletSurfaceRow> inlet_surface;
    Section<Mesh> inlet_file;                   ///< where its own file lies
    Section<Removal> removal, half_space;
    Section<RemovalBoxRow> removal_box;
    Section<Motion> motion, rotation, oscillation;
    Section<PathRow> motion_path;

    /// Calls visit(section) in the order of the docs.
    template <class Visit>
    void each(Visit&& visit) const {
        visit(top), visit(simulation), visit(domain), visit(contact), visit(search), visit(rays), visit(output), visit(limits);
        visit(render), visit(camera), visit(material), visit(pair), visit(placement), visit(group), visit(lattice);
        visit(list), visit(file), visit(fill), visit(release), visit(size);
        for (const auto& law : size_laws) visit(law);
        visit(plane), visit(mesh_file), visit(mesh), visit(terrain_files), visit(terrain);
        visit(motion), visit(rotation), visit(oscillation), visit(motion_path);
        visit(inlet), visit(stream), visit(inlet_box), visit(inlet_surface), visit(inlet_file);
        visit(removal), visit(removal_box), visit(half_space);
    }
};

const Schema& schema();

}  // namespace grainray::scene
