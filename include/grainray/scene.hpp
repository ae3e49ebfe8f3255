// A scene as plain structs, SI units throughout. src/scene/ fills it from TOML; a program may fill it by hand.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "grainray/surfaces.hpp"

namespace grainray {

/// Properties of one material. Stiffness in N/m, damping as a fraction beta of c = 2 beta sqrt(m k).
struct Material {
    std::string name;
    double density = 2000;              ///< kg/m3
    double normal_stiffness = 1e5;      ///< k_n, N/m
    double tangential_stiffness = 1e5;  ///< k_t, N/m
    double friction = 0.5;              ///< Coulomb coefficient mu
    double normal_damping = 0.5;        ///< beta_n
    double tangential_damping = 0;      ///< beta_t
};

/// What two materials do in contact, after the pair table and the mixing rule: the result of contact_parameters().
struct MaterialPair {
    std::array<std::string, 2> materials;
    double normal_stiffness = 0, tangential_stiffness = 0, friction = 0, normal_damping = 0, tangential_damping = 0;
};

/// One row of the pair table, for two materials or one with itself. An absent field is what the mixing rule gives.
struct PairRow {
    std::array<std::string, 2> materials;
    std::optional<double> normal_stiffness, tangential_stiffness, friction, normal_damping, tangential_damping;
};

enum class Mixing {
    series,  ///< k = 2 k1 k2 / (k1 + k2), the smaller mu, the mean beta
    wall,    ///< a boundary's own values; two different particle materials mix as series
};

struct ContactSettings {
    std::string law = "linear";
    Mixing mixing = Mixing::wall;
    double mass_damping = 0;  ///< alpha of a <- a (1 - alpha sign(a v)), per axis
};

enum class SizeLaw { fixed, uniform, normal, lognormal, table };

/// Radii of a group, metres.
struct SizeDistribution {
    SizeLaw law = SizeLaw::fixed;
    double radius = 0;                       ///< fixed
    double minimum = 0, maximum = 0;         ///< uniform; cut-offs of normal and lognormal
    double mean = 0, deviation = 0;          ///< normal, lognormal: mean and standard deviation of the radius
    std::vector<double> radii, weights;      ///< table: radii and their share by number
};

/// Bounds of the radii that can occur, m.
double smallest_radius(const SizeDistribution&);
double largest_radius(const SizeDistribution&);

struct Lattice {
    std::array<std::int64_t, 3> count{1, 1, 1};
    Vec3d spacing;   ///< distance of the lattice points along each axis, m
    Vec3d origin;    ///< the first lattice point, m
    Vec3d jitter;    ///< each particle is shifted by U(0, jitter) along each axis, m
};
struct ParticleList {
    std::vector<Vec3d> positions;
    std::vector<double> radii;       ///< one, or one a particle
    std::vector<Vec3d> velocities;   ///< none, or one a particle
    std::vector<Vec3d> angular_velocities;
};
struct ParticleFile {
    std::filesystem::path path;  ///< CSV with a header; columns x y z radius [vx vy vz] [wx wy wz]
};
struct RandomFill {
    Box box;
    std::int64_t count = 0;     ///< 0: until the solid fraction is reached
    double solid_fraction = 0;  ///< 0: until the count is reached
};

/// What slides: a lattice of equal particles between the ground and a surface above it.
struct Release {
    double spacing = 0;                  ///< m; 0: found for the count
    std::int64_t count = 0;              ///< about so many particles; 0: as the spacing gives
    double jitter = 0;                   ///< each is shifted by U(0, jitter) along x and y, m
    double radius = 0;                   ///< m; 0: half of what the jitter leaves of the spacing
    std::filesystem::path polygon_file;  ///< CSV with columns x y, or GeoJSON; empty: the surface is terrain.before
    double thickness = 0;                ///< with a polygon: height of the surface over the ground, m
};

/// A named group of particles of one material.
struct ParticleGroup {
    std::string name;
    std::string material;
    std::variant<Lattice, ParticleList, ParticleFile, RandomFill, Release> placement;
    SizeDistribution size;
    Vec3d velocity, angular_velocity;
};

/// A place on the way of a boundary that follows a table.
struct Waypoint {
    double time = 0;  ///< s after the start of the motion
    Vec3d shift;      ///< from where the boundary was placed, m
};

/// How a boundary moves between start and stop; it stands still before and after (and keeps where it got to).
struct Motion {
    Vec3d velocity;                        ///< constant, m/s
    Vec3d rotation_axis, rotation_point;   ///< unit axis and a point on it
    double rotation_rate = 0;              ///< rad/s about the axis
    Vec3d oscillation_amplitude;           ///< m: shift = amplitude sin(2 pi f (t - start) + phase) - its value at start
    double oscillation_frequency = 0;      ///< Hz
    double oscillation_phase = 0;          ///< rad
    std::filesystem::path path_file;       ///< CSV with the columns t x y z; empty: none
    std::vector<Waypoint> path;            ///< its rows, ascending in time: straight between them, still before and after
    double start = 0, stop = std::numeric_limits<double>::infinity();  ///< s
    bool moves() const { return velocity != Vec3d{} || rotation_rate != 0 || oscillation_frequency != 0 || path.size() > 1; }
};

/// A half-space boundary: particles live where normal . (x - point) > 0.
struct Plane {
    std::string name;
    std::string material;
    Vec3d point, normal{0, 0, 1};  ///< normal has unit length after loading
    Motion motion;
};

/// A boundary of triangles. Both of its sides are solid: a particle belongs to the side from which it came.
struct Mesh {
    std::string name;
    std::string material;
    std::filesystem::path file;             ///< STL or OBJ
    double scale = 1;                       ///< metres a unit of the file
    Vec3d rotation;                         ///< about the x, then the y, then the z axis of the file, rad
    Vec3d translation;                      ///< after scaling and turning, m
    Motion motion;
    std::optional<TriangleMesh> geometry;   ///< given by a program instead of a file
};

enum class TerrainEdge {
    open,   ///< particles leave the grid and are removed
    walled, ///< upright planes stand round it
};

/// The ground as a grid of elevations. Particles live above it.
struct Terrain {
    std::string material;
    std::filesystem::path after_file;       ///< the ground
    std::filesystem::path before_file;      ///< the surface before the slide; empty: none
    std::int64_t smooth = 1;                ///< every cell is cut into smooth x smooth, by cubic interpolation
    TerrainEdge edge = TerrainEdge::open;
    std::optional<ElevationGrid> after, before;  ///< given by a program instead of files
};

/// So many particles, or so much mass; neither: not given.
struct Amount {
    double particles = 0;
    double mass = 0;  ///< kg
    bool given() const { return particles > 0 || mass > 0; }
};

/// A surface in front of which a stream's particles appear, on the side to which they go.
struct InletSurface {
    std::string mesh;            ///< name of a mesh of the scene, with which it moves; empty: `surface` is read
    Mesh surface;                ///< no boundary: its material and motion have no meaning
    std::optional<Box> facets;   ///< those alone that lie wholly in it
    double depth = 0;            ///< of the layer, along the way of the particles, m
};

/// Particles that appear during the run.
struct ParticleStream {
    std::string name;
    std::string material;
    std::variant<Box, InletSurface> inlet;
    Amount rate;             ///< a second
    Amount total;            ///< after which it ends; not given: no end
    double start = 0, stop = std::numeric_limits<double>::infinity();  ///< s
    double interval = 0;     ///< s between two insertions; 0: a quarter of the time in which a particle crosses the inlet
    std::int64_t attempts = 100;  ///< places tried for a particle at an insertion
    SizeDistribution size;
    Vec3d velocity, velocity_spread, angular_velocity;  ///< each component of the velocity is drawn from velocity +- spread
};

enum class RemovalRegion { box, half_space, outside };

/// Takes particles out whose centre is in a region.
struct Removal {
    std::string name;
    RemovalRegion region = RemovalRegion::box;
    Box box{};                    ///< of RemovalRegion::box
    Vec3d point, normal{0, 0, 1}; ///< of half_space: the side to which the normal points; unit length after loading
    std::int64_t steps = 100;     ///< between two looks
};

struct Domain {
    std::optional<Box> box;                   ///< required along periodic axes; elsewhere a limit that must not be left
    std::array<bool, 3> periodic{};
};

enum class Trigger {
    safe,       ///< rebuild before any particle has moved its own margin
    published,  ///< rebuild once a particle has moved the whole skin: misses approaching pairs, for comparison only
};

struct RaySettings {
    std::string variant = "default";  ///< default | published
};
struct SearchSettings {
    std::string backend = "auto";  ///< auto | brute | cells | rays
    RaySettings rays;
    double skin = 0;               ///< least margin as a fraction of the particle's radius; 0: chosen by the program
    double interval = 0;           ///< steps a margin is sized for: margin = speed dt interval; 0: chosen by the program
    Trigger trigger = Trigger::safe;
};

struct OutputSettings {
    double frames = 0;       ///< s between frames; 0: first and last state only
    double history = 0;      ///< s between rows of history.csv; 0: as frames
    double checkpoints = 0;  ///< s between checkpoints; 0: as frames
    std::string format = "vtp";
    std::vector<std::string> fields;  ///< empty: all
};

struct Limits {
    double overlap = 1.9;  ///< largest overlap / smaller radius before the run stops
    double speed = 0;      ///< m/s; 0: smallest radius / dt
};

struct Camera {
    std::optional<Vec3d> eye, target;  ///< absent: chosen to show everything
    Vec3d up{0, 0, 1};
    double field_of_view = 35;         ///< degrees, vertical
};
struct RenderSettings {
    Camera camera;
    std::string color_by = "speed";
    std::optional<double> color_minimum, color_maximum;
    std::int64_t width = 1280, height = 720;
    double mesh_opacity = 0.2;           ///< of meshes: 0 not seen, 1 nothing seen through them
    std::optional<Vec3d> mesh_cut;       ///< direction of the half of the meshes that is left out
};

struct Scene {
    std::string title;
    std::filesystem::path file;     ///< where it was read from; relative paths in it start there
    std::string source;             ///< its text as read, with every --set applied as a comment at the end
    std::string method = "dem";
    double dt = 0;                  ///< s
    double duration = 0;            ///< s
    Vec3d gravity{0, 0, -10};       ///< m/s2
    std::uint64_t seed = 1;
    Domain domain;
    ContactSettings contact;
    SearchSettings search;
    OutputSettings output;
    Limits limits;
    RenderSettings render;
    std::vector<Material> materials;
    std::vector<PairRow> pairs;
    std::vector<ParticleGroup> particles;
    std::vector<Plane> planes;
    std::vector<Mesh> meshes;
    std::optional<Terrain> terrain;
    std::vector<ParticleStream> streams;
    std::vector<Removal> removals;
    std::uint64_t steps() const { return static_cast<std::uint64_t>(std::llround(duration / dt)); }
};

/// Particles as the scene places them, before the simulation takes them; id = position in these arrays.
struct InitialState {
    std::vector<Vec3d> positions;
    std::vector<double> radii;
    std::vector<Vec3d> velocities, angular_velocities;
    std::vector<std::uint32_t> materials;  ///< index into Scene::materials
    std::size_t size() const { return positions.size(); }
};

/// Reads a scene file. overrides: "key.path=value" with a TOML value. Throws InputError with file:line:column.
Scene load_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});
/// As load_scene, from text; `name` stands for the file in messages.
Scene parse_scene(const std::string& text, const std::string& name, const std::vector<std::string>& overrides = {});
/// Places every particle of the scene; repeatable for a seed. Throws InputError (unreadable CSV, a fill that cannot fit).
InitialState place_particles(const Scene&);
/// The field table as text (`grainray info --schema`): key, unit, default, range, meaning.
std::string schema_text();

/// Contact parameters of material a with b; boundary_b: b belongs to a plane. Applies the pair table, then the mixing rule.
MaterialPair contact_parameters(const Scene&, std::size_t a, std::size_t b, bool boundary_b);

/// Triangles of a mesh, scaled and turned but not shifted by its translation: clean (see MeshReport) and facing the same
/// way where they share edges. Throws InputError where the file cannot be read or holds no triangle.
TriangleMesh load_mesh(const Scene&, const Mesh&, MeshReport* = nullptr);
/// The ground, refined where the scene asks for it. Throws InputError.
ElevationGrid load_ground(const Scene&);
/// The surface before the slide, refined as the ground. Throws InputError where its nodes are not those of the ground.
ElevationGrid load_surface_before(const Scene&);

/// How far a motion has got at time t: a point x has gone to point + shift + (x - point) turned by `angle` about `axis`,
/// where point is rotation_point.
struct MotionState {
    Vec3d shift;
    double angle = 0;
    Vec3d velocity, angular_velocity;  ///< of the point, and about it
};
MotionState motion_at(const Motion&, double time);
/// A vector turned by an angle about a unit axis.
Vec3d turned(const Vec3d&, const Vec3d& axis, double angle);
/// Bound on the speed of the point `rotation_point` at any time, m/s.
double greatest_speed(const Motion&);

/// Where a plane is at time t and how it moves there.
struct PlaneState {
    Vec3d point, normal;
    Vec3d velocity;          ///< of `centre`
    Vec3d angular_velocity;  ///< about `centre`
    Vec3d centre;
};
PlaneState plane_at(const Plane&, double time);

}  // namespace grainray
