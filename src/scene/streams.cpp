// [streams.NAME] -> ParticleStream, [removals.NAME] -> Removal.
#include <fmt/format.h>

#include <algorithm>

#include "scene/read.hpp"

namespace grainray::scene {
namespace {

void check_times(const Node& table, const ParticleStream& stream) {
    if (!(stream.stop > stream.start)) fail_key(table, "stop", fmt::format("must be greater than start ({} s)", stream.start));
}

/// Nothing appears where what has appeared before stays.
void check_way_out(const Node& table, const ParticleStream& stream, const Scene& s) {
    if (!(stream.velocity == Vec3d{}) || !(s.gravity == Vec3d{})) return;
    fail_key(table, "velocity", "nothing carries the particles out of the inlet: give a velocity, as there is no gravity (a typical value is [0, 0, -1])");
}

Box read_inlet_box(const Node& table, const ParticleStream& stream, const Scene& s) {
    InletBoxRow row;
    read_fields(table, schema().inlet_box, row);
    check_box(table, row.lower, row.upper, s);
    const double diameter = 2 * largest_radius(stream.size);
    for (int axis = 0; axis < 3; ++axis)
        if (const double width = row.upper[axis] - row.lower[axis]; diameter > width)
            fail_key(table, "upper", fmt::format("the box is {} m wide along {} and the largest particle {} m; enlarge the box or take smaller particles", width, "xyz"[axis], diameter));
    return {row.lower, row.upper};
}

void check_mesh(const Node& table, const std::string& name, const Scene& s) {
    std::vector<std::string_view> known;
    for (const Mesh& mesh : s.meshes) known.push_back(mesh.name);
    if (std::find(known.begin(), known.end(), name) != known.end()) return;
    if (known.empty()) fail_key(table, "mesh", fmt::format("unknown mesh '{0}': the scene has none; add a table [meshes.{0}], or give 'file' for a surface that is no boundary", name));
    fail_key(table, "mesh", fmt::format("unknown mesh '{}'{} Defined: {}", name, did_you_mean(name, known), join(known)));
}

InletSurface read_inlet_surface(const Node& table, const std::string& name, const ParticleStream& stream, const Scene& s) {
    InletSurfaceRow row;
    InletSurface inlet;
    read_fields(table, schema().inlet_surface, row);
    if (row.mesh.has_value() == row.file.has_value())
        fail_key(table, row.mesh ? "file" : "mesh", row.mesh ? "give mesh or file, not both" : "an inlet needs one of mesh (of the scene) and file (no boundary)");
    if (row.mesh) {
        for (const auto& field : schema().inlet_file.fields)
            if (table.has(field.key)) fail_key(table, field.key, fmt::format("mesh '{}' has its own place; give it in [meshes.{}]", *row.mesh, *row.mesh));
        check_mesh(table, inlet.mesh = *row.mesh, s);
    } else {
        read_fields(table, schema().inlet_file, inlet.surface);
        inlet.surface.name = name;
        inlet.surface.file = *row.file;
    }
    if (row.lower.has_value() != row.upper.has_value())
        fail_key(table, row.lower ? "lower" : "upper", fmt::format("a box needs both corners; add '{}'", row.lower ? "upper" : "lower"));
    if (row.lower) {
        for (int axis = 0; axis < 3; ++axis)
            if (!((*row.upper)[axis] >= (*row.lower)[axis])) fail_key(table, "upper", fmt::format("must be at least 'lower' along {} ({} m)", "xyz"[axis], (*row.lower)[axis]));
        inlet.facets = Box{*row.lower, *row.upper};
    }
    inlet.depth = row.depth;
    if (const double diameter = 2 * largest_radius(stream.size); diameter > inlet.depth)
        fail_key(table, "depth", fmt::format("the largest particle is {} m wide; deepen the layer or take smaller particles", diameter));
    return inlet;
}

void check_stream_keys(const Node& table, Inlet type, SizeLaw law) {
    std::vector<std::string_view> known;
    append_keys(known, schema().inlet);
    append_keys(known, schema().stream);
    append_keys(known, schema().size);
    append_keys(known, schema().size_laws[static_cast<std::size_t>(law)]);
    if (type == Inlet::box) append_keys(known, schema().inlet_box);
    else append_keys(known, schema().inlet_surface), append_keys(known, schema().inlet_file);
    check_keys(table, std::move(known), fmt::format("type = \"{}\", size = \"{}\"", schema().inlet.fields[0].choices[static_cast<std::size_t>(type)],
                                                    schema().size.fields[0].choices[static_cast<std::size_t>(law)]));
}

}  // namespace

ParticleStream read_stream(const Node& table, const std::string& name, const Scene& s) {
    ParticleStream stream;
    InletRow inlet;
    SizeRow size;
    stream.name = name;
    read_fields(table, schema().inlet, inlet);
    read_fields(table, schema().size, size);
    check_stream_keys(table, inlet.type, size.law);
    read_fields(table, schema().stream, stream);
    check_material(table.child("material"), stream.material, s);
    check_times(table, stream);
    check_way_out(table, stream, s);
    stream.size = read_size(table, size);
    if (inlet.type == Inlet::box) stream.inlet = read_inlet_box(table, stream, s);
    else stream.inlet = read_inlet_surface(table, name, stream, s);
    return stream;
}

Removal read_removal(const Node& table, const std::string& name, const Scene& s) {
    Removal removal;
    removal.name = name;
    read_fields(table, schema().removal, removal);
    std::vector<std::string_view> known;
    append_keys(known, schema().removal);
    if (removal.region == RemovalRegion::box) append_keys(known, schema().removal_box);
    if (removal.region == RemovalRegion::half_space) append_keys(known, schema().half_space);
    check_keys(table, std::move(known), fmt::format("type = \"{}\"", schema().removal.fields[0].choices[static_cast<std::size_t>(removal.region)]));
    if (removal.region == RemovalRegion::box) {
        RemovalBoxRow row;
        read_fields(table, schema().removal_box, row);
        for (int axis = 0; axis < 3; ++axis)
            if (!(row.upper[axis] > row.lower[axis])) fail_key(table, "upper", fmt::format("must be greater than 'lower' along {} ({} m)", "xyz"[axis], row.lower[axis]));
        removal.box = {row.lower, row.upper};
    } else if (removal.region == RemovalRegion::half_space) {
        read_fields(table, schema().half_space, removal);
        removal.normal = unit_vector(table, "normal", removal.normal);
    } else if (!s.domain.box) {
        fail_key(table, "type", "there is no domain to be outside of; give domain.lower and domain.upper");
    }
    return removal;
}

}  // namespace grainray::scene
