// Tables of the document -> structs of the scene, with the checks that need more than one field.
#pragma once

#include "scene/schema.hpp"

namespace grainray::scene {

/// Throws where a key is given that, with the others, makes no sense; the table where the key is absent.
[[noreturn]] void fail_key(const Node& table, std::string_view key, const std::string& why);
/// A direction of any length -> unit length. Throws for the zero vector.
Vec3d unit_vector(const Node& table, std::string_view key, const Vec3d&);
/// Throws where `name`, written under `key`, is no material of the scene.
void check_material(const Node& where, const std::string& name, const Scene&);

ParticleGroup read_group(const Node&, const std::string& name, const Scene&);
Plane read_plane(const Node&, const std::string& name, const Scene&);
Mesh read_mesh(const Node&, const std::string& name, const Scene&);
Terrain read_terrain(const Node&, const Scene&);
ParticleStream read_stream(const Node&, const std::string& name, const Scene&);
Removal read_removal(const Node&, const std::string& name, const Scene&);
/// The fields of a size law, its name being in the row.
SizeDistribution read_size(const Node&, SizeRow);
/// Throws where upper is not greater than lower along each axis, or the box leaves the domain.
void check_box(const Node&, const Vec3d& lower, const Vec3d& upper, const Scene&);
/// The table `motion` of a boundary's table.
Motion read_motion(const Node& boundary, const Scene&);

}  // namespace grainray::scene
