// THE field table. Adding a field: one member in a struct of scene.hpp, one row here, docs/scene.md made again.
#include "scene/schema.hpp"

namespace grainray::scene {
namespace {

constexpr Range fraction{0, 1, false, false};
constexpr Range up_to_2_31{0, 2147483648.0, false, false};
const std::vector<std::string_view> frame_field_names{"radius", "velocity", "angular_velocity", "id", "material",
                                                      "coordination", "contact_force", "mass"};

std::vector<std::string_view> color_names() {
    auto names = frame_field_names;
    names.insert(names.begin(), {"speed", "depth"});
    return names;
}

void add_run_tables(Schema& s) {
    s.top = {"(top level)", "Before the first table.", {
        field(&Scene::title, {.key = "title", .text = "name of the scene, for reports"})}};
    s.simulation = {"simulation", "What is computed, and for how long.", {
        field(&Scene::method, {.key = "method", .text = "particle method", .choices = {"dem"}}),
        field(&Scene::dt, {.key = "dt", .text = "time step", .unit = unit::time, .range = positive, .typical = "1e-3 s", .required = true}),
        field(&Scene::duration, {.key = "duration", .text = "simulated time", .unit = unit::time, .range = non_negative, .typical = "10 s", .required = true}),
        field(&Scene::gravity, {.key = "gravity", .text = "acceleration of everything", .unit = unit::acceleration, .typical = "[0, 0, -10]"}),
        field(&Scene::seed, {.key = "seed", .text = "seed of every random placement", .range = non_negative, .typical = "1"})}};
    s.domain = {"domain", "The box of the world. Needed along periodic axes; elsewhere a limit that no particle may leave.", {
        field(&DomainRow::lower, {.key = "lower", .text = "lower corner", .unit = unit::length}),
        field(&DomainRow::upper, {.key = "upper", .text = "upper corner", .unit = unit::length}),
        field(&DomainRow::periodic, {.key = "periodic", .text = "axes along which the world repeats itself"})}};
    s.contact = {"contact", "How particles meet.", {
        field(&ContactSettings::law, {.key = "law", .text = "contact law", .choices = {"linear"}}),
        field(&ContactSettings::mixing, {.key = "mixing", .text = "two materials without a row in [[pairs]]: series takes k = 2 k1 k2 / (k1 + k2), "
            "the smaller friction and the mean damping; wall takes the boundary's own values, and series between particles", .choices = {"series", "wall"}}),
        field(&ContactSettings::mass_damping, {.key = "mass_damping", .text = "alpha of a <- a (1 - alpha sign(a v)) per axis", .range = fraction, .typical = "0.1"})}};
    s.search = {"search", "The neighbour search.", {
        field(&SearchSettings::backend, {.key = "backend", .text = "how neighbours are found", .choices = {"auto", "brute", "cells", "rays"}}),
        field(&SearchSettings::skin, {.key = "skin", .text = "least margin as a fraction of the radius; 0: chosen by the program", .range = non_negative, .typical = "0.1"}),
        field(&SearchSettings::interval, {.key = "interval", .text = "steps a margin is sized for; 0: chosen by the program", .range = non_negative, .typical = "20"}),
        field(&SearchSettings::trigger, {.key = "trigger", .text = "when neighbours are found anew: safe misses no contact; published can, and is there to compare with", .choices = {"safe", "published"}})}};
    s.rays = {"search.rays", "Search by ray tracing: Embree on the CPU, OptiX on NVIDIA GPUs.", {
        field(&RaySettings::variant, {.key = "variant", .text = "published is the algorithm as it was published, to compare with: boxes of the largest reach; it finds the same neighbours",
            .choices = {"default", "published"}})}};
}

void add_output_tables(Schema& s) {
    s.output = {"output", "What is written, and how often.", {
        field(&OutputSettings::frames, {.key = "frames", .text = "time between frames; 0: the first and the last state only", .unit = unit::time, .range = non_negative, .typical = "0.1 s"}),
        field(&OutputSettings::history, {.key = "history", .text = "time between rows of history.csv; 0: as frames", .unit = unit::time, .range = non_negative, .typical = "0.01 s"}),
        field(&OutputSettings::checkpoints, {.key = "checkpoints", .text = "time between checkpoints; 0: as frames", .unit = unit::time, .range = non_negative, .typical = "1 s"}),
        field(&OutputSettings::format, {.key = "format", .text = "file format of frames", .choices = {"vtp", "zlib.vtp", "csv"}}),
        field(&OutputSettings::fields, {.key = "fields", .text = "what frames hold besides positions; []: everything", .choices = frame_field_names})}};
    s.limits = {"limits", "Past these the run stops, because the result would be wrong.", {
        field(&Limits::overlap, {.key = "overlap", .text = "largest overlap over the smaller radius", .range = positive, .typical = "1.9"}),
        field(&Limits::speed, {.key = "speed", .text = "largest speed; 0: smallest radius over time step", .unit = unit::speed, .range = non_negative, .typical = "50 m/s"})}};
    s.render = {"render", "Pictures.", {
        field(&RenderSettings::color_by, {.key = "color_by", .text = "field shown as colour", .choices = color_names()}),
        field(&RenderSettings::color_minimum, {.key = "color_minimum", .text = "value of the first colour; absent: smallest in the picture"}),
        field(&RenderSettings::color_maximum, {.key = "color_maximum", .text = "value of the last colour; absent: largest in the picture"}),
        field(&RenderSettings::width, {.key = "width", .text = "pixels", .range = {16, 16384}, .typical = "1280"}),
        field(&RenderSettings::height, {.key = "height", .text = "pixels", .range = {16, 16384}, .typical = "720"}),
        field(&RenderSettings::mesh_opacity, {.key = "mesh_opacity", .text = "of meshes; 0: not seen, 1: nothing seen through them", .range = fraction, .typical = "0.2"}),
        field(&RenderSettings::mesh_cut, {.key = "mesh_cut", .text = "leaves out the half of the meshes towards this direction, to look inside", .typical = "[0, -1, 0]"})}};
    s.camera = {"render.camera", "Where the picture is taken from; absent: so that everything shows.", {
        field(&Camera::eye, {.key = "eye", .text = "position", .unit = unit::length}),
        field(&Camera::target, {.key = "target", .text = "point looked at", .unit = unit::length}),
        field(&Camera::up, {.key = "up", .text = "direction that is up in the picture"}),
        field(&Camera::field_of_view, {.key = "field_of_view", .text = "vertical; a plain number is in degrees", .unit = unit::view_angle, .range = {0, 180, true, true}, .typical = "35"})}};
}

void add_material_tables(Schema& s) {
    s.material = {"materials.NAME", "A material. Damping is a fraction beta of c = 2 beta sqrt(m k), m the mean mass of the two particles (the particle's own against a plane).", {
        field(&Material::density, {.key = "density", .text = "of the solid", .unit = unit::density, .range = positive, .typical = "2000 kg/m^3"}),
        field(&Material::normal_stiffness, {.key = "normal_stiffness", .text = "k_n", .unit = unit::stiffness, .range = positive, .typical = "1e5 N/m"}),
        field(&Material::tangential_stiffness, {.key = "tangential_stiffness", .text = "k_t", .unit = unit::stiffness, .range = non_negative, .typical = "1e5 N/m"}),
        field(&Material::friction, {.key = "friction", .text = "Coulomb coefficient mu", .range = non_negative, .typical = "0.5"}),
        field(&Material::normal_damping, {.key = "normal_damping", .text = "beta_n", .range = non_negative, .typical = "0.5"}),
        field(&Material::tangential_damping, {.key = "tangential_damping", .text = "beta_t", .range = non_negative, .typical = "0"})}};
    s.pair = {"[[pairs]]", "Two materials (or one with itself) in contact. A field left out is what the mixing rule gives.", {
        field(&PairRow::materials, {.key = "materials", .text = "names of the two materials", .typical = "[\"grain\", \"wall\"]", .required = true}),
        field(&PairRow::normal_stiffness, {.key = "normal_stiffness", .text = "k_n", .unit = unit::stiffness, .range = positive, .typical = "1e5 N/m", .fallback = "mixed"}),
        field(&PairRow::tangential_stiffness, {.key = "tangential_stiffness", .text = "k_t", .unit = unit::stiffness, .range = non_negative, .typical = "1e5 N/m", .fallback = "mixed"}),
        field(&PairRow::friction, {.key = "friction", .text = "mu", .range = non_negative, .typical = "0.5", .fallback = "mixed"}),
        field(&PairRow::normal_damping, {.key = "normal_damping", .text = "beta_n", .range = non_negative, .typical = "0.5", .fallback = "mixed"}),
        field(&PairRow::tangential_damping, {.key = "tangential_damping", .text = "beta_t", .range = non_negative, .typical = "0", .fallback = "mixed"})}};
}

void add_particle_tables(Schema& s) {
    s.placement = {"particles.NAME", "A group of particles; its `type` says how they are placed.", {
        field(&PlacementRow::type, {.key = "type", .text = "how the particles are placed", .choices = {"lattice", "list", "file", "fill", "release"}, .required = true})}};
    s.group = {"particles.NAME, every type", "", {
        field(&ParticleGroup::material, {.key = "material", .text = "name of their material", .required = true}),
        field(&ParticleGroup::velocity, {.key = "velocity", .text = "at the start, where a list or a file gives no other", .unit = unit::speed}),
        field(&ParticleGroup::angular_velocity, {.key = "angular_velocity", .text = "at the start, where a list or a file gives no other", .unit = unit::rotation})}};
    s.lattice = {"particles.NAME, type = \"lattice\"", "A box of particles in rows; x runs fastest. Their radii: see `size`.", {
        field(&Lattice::count, {.key = "count", .text = "particles along x, y and z", .range = up_to_2_31, .typical = "[32, 10, 63]", .required = true}),
        field(&Lattice::spacing, {.key = "spacing", .text = "distance of neighbours along x, y and z", .unit = unit::length, .range = positive, .typical = "[0.24, 0.24, 0.24]", .required = true}),
        field(&Lattice::origin, {.key = "origin", .text = "centre of the first particle", .unit = unit::length, .typical = "[0.12, 0.12, 0.12]", .required = true}),
        field(&Lattice::jitter, {.key = "jitter", .text = "each particle is shifted by a random length from 0 to this", .unit = unit::length, .range = non_negative, .typical = "[0.01, 0.01, 0]"})}};
    s.list = {"particles.NAME, type = \"list\"", "Particles one by one.", {
        field(&ParticleList::positions, {.key = "positions", .text = "centres", .unit = unit::length, .typical = "[[0, 0, 1]]", .required = true}),
        field(&ParticleList::radii, {.key = "radii", .text = "one for all, or one a particle", .unit = unit::length, .range = positive, .typical = "0.1 m", .required = true}),
        field(&ParticleList::velocities, {.key = "velocities", .text = "none, or one a particle", .unit = unit::speed}),
        field(&ParticleList::angular_velocities, {.key = "angular_velocities", .text = "none, or one a particle", .unit = unit::rotation})}};
    s.file = {"particles.NAME, type = \"file\"", "Particles from a CSV file with a header line.", {
        field(&FileRow::path, {.key = "path", .text = "columns x y z radius [vx vy vz] [wx wy wz] in SI units, others are not read; relative to the scene file", .typical = "\"particles.csv\"", .required = true})}};
    s.fill = {"particles.NAME, type = \"fill\"", "Random places in a box, without overlap in the group. Needs one of count and solid_fraction; radii: see `size`.", {
        field(&FillRow::lower, {.key = "lower", .text = "lower corner of the box", .unit = unit::length, .required = true}),
        field(&FillRow::upper, {.key = "upper", .text = "upper corner of the box", .unit = unit::length, .required = true}),
        field(&FillRow::count, {.key = "count", .text = "number of particles", .range = up_to_2_31, .typical = "20000"}),
        field(&FillRow::solid_fraction, {.key = "solid_fraction", .text = "solid volume over volume of the box", .range = {0, 0.74, true, false}, .typical = "0.25"})}};
}

void add_release_table(Schema& s) {
    s.release = {"particles.NAME, type = \"release\"", "What slides: equal particles in rows between the ground and terrain.before, or a layer of a given thickness inside a polygon. Needs one of spacing and count.", {
        field(&ReleaseRow::spacing, {.key = "spacing", .text = "distance of neighbours; volume over spacing cubed is the number of particles", .unit = unit::length, .range = positive, .typical = "0.74 m"}),
        field(&ReleaseRow::count, {.key = "count", .text = "about so many particles: the spacing is found for it", .range = {1, 2147483648.0}, .typical = "20000"}),
        field(&ReleaseRow::jitter, {.key = "jitter", .text = "each particle is shifted along x and y by a random length from 0 to this", .unit = unit::length, .range = non_negative, .typical = "0.05 m"}),
        field(&ReleaseRow::radius, {.key = "radius", .text = "of every particle", .unit = unit::length, .range = positive, .typical = "0.37 m", .fallback = "(spacing - jitter) / 2"}),
        field(&ReleaseRow::polygon, {.key = "polygon", .text = "outline of what slides: CSV with the columns x y, or GeoJSON, in the coordinates of the terrain; relative to the scene file", .typical = "\"release.csv\""}),
        field(&ReleaseRow::thickness, {.key = "thickness", .text = "of the layer inside the polygon, upright", .unit = unit::length, .range = positive, .typical = "2 m"})}};
}

void add_size_tables(Schema& s) {
    const auto length = [](std::string_view key, std::string_view text, bool required, std::string fallback = "") {
        return FieldInfo{.key = key, .text = text, .unit = unit::length, .range = positive, .typical = "0.1 m", .required = required, .fallback = std::move(fallback)};
    };
    s.size = {"particles.NAME, streams.NAME, radii of a lattice, a fill or a stream", "", {
        field(&SizeRow::law, {.key = "size", .text = "distribution of the radii, by number", .choices = {"fixed", "uniform", "normal", "lognormal", "table"}})}};
    s.size_laws[0] = {"particles.NAME, streams.NAME, size = \"fixed\"", "", {
        field(&SizeRow::radius, length("radius", "radius of every particle", true))}};
    s.size_laws[1] = {"particles.NAME, streams.NAME, size = \"uniform\"", "", {
        field(&SizeRow::minimum, length("radius_minimum", "smallest radius", true)),
        field(&SizeRow::maximum, length("radius_maximum", "largest radius", true))}};
    s.size_laws[2] = {"particles.NAME, streams.NAME, size = \"normal\"", "Truncated: radii beyond the two cut-offs are drawn again.", {
        field(&SizeRow::mean, length("radius_mean", "mean, before the cut-offs", true)),
        field(&SizeRow::deviation, length("radius_deviation", "standard deviation, before the cut-offs", true)),
        field(&SizeRow::minimum, length("radius_minimum", "lower cut-off", false, "mean - 3 deviations")),
        field(&SizeRow::maximum, length("radius_maximum", "upper cut-off", false, "mean + 3 deviations"))}};
    s.size_laws[3] = {"particles.NAME, streams.NAME, size = \"lognormal\"", s.size_laws[2].text, s.size_laws[2].fields};
    s.size_laws[3].fields[2].fallback = "3 log-deviations below the median";
    s.size_laws[3].fields[3].fallback = "3 log-deviations above the median";
    s.size_laws[4] = {"particles.NAME, streams.NAME, size = \"table\"", "", {
        field(&SizeRow::radii, {.key = "radii", .text = "radii that occur", .unit = unit::length, .range = positive, .typical = "[0.01, 0.04]", .required = true}),
        field(&SizeRow::weights, {.key = "weights", .text = "their shares by number, in any proportion; []: equal", .range = non_negative, .typical = "[10, 1]"})}};
}

void add_plane_tables(Schema& s) {
    s.plane = {"planes.NAME", "A half-space: particles live on the side that the normal points to.", {
        field(&Plane::material, {.key = "material", .text = "name of its material", .required = true}),
        field(&Plane::point, {.key = "point", .text = "a point of the plane", .unit = unit::length}),
        field(&Plane::normal, {.key = "normal", .text = "direction towards the particles, any length"})}};
    s.motion = {"planes.NAME.motion, meshes.NAME.motion", "The boundary stands still before `start` and, where it has got to, after `stop`.", {
        field(&Motion::velocity, {.key = "velocity", .text = "constant velocity", .unit = unit::speed}),
        field(&Motion::start, {.key = "start", .text = "when the motion starts", .unit = unit::time, .range = non_negative, .typical = "0 s"}),
        field(&Motion::stop, {.key = "stop", .text = "when it stops", .unit = unit::time, .range = non_negative, .typical = "5 s", .fallback = "never"})}};
    s.rotation = {"planes.NAME.motion.rotation, meshes.NAME.motion.rotation", "Turns about an axis; velocity and oscillation carry the axis along.", {
        field(&Motion::rotation_axis, {.key = "axis", .text = "direction of the axis, any length", .typical = "[0, 1, 0]", .required = true}),
        field(&Motion::rotation_point, {.key = "point", .text = "a point of the axis", .unit = unit::length, .typical = "[0, 0, 0]", .required = true}),
        field(&Motion::rotation_rate, {.key = "rate", .text = "right-handed about the axis", .unit = unit::rotation, .typical = "10 rpm", .required = true})}};
    s.oscillation = {"planes.NAME.motion.oscillation, meshes.NAME.motion.oscillation", "Shifts by amplitude (sin(2 pi frequency (t - start) + phase) - sin(phase)).", {
        field(&Motion::oscillation_amplitude, {.key = "amplitude", .text = "with direction", .unit = unit::length, .typical = "[0, 0, 0.005]", .required = true}),
        field(&Motion::oscillation_frequency, {.key = "frequency", .text = "periods a second", .unit = unit::frequency, .range = positive, .typical = "10 Hz", .required = true}),
        field(&Motion::oscillation_phase, {.key = "phase", .text = "phase at the start", .unit = unit::angle})}};
}

void add_surface_tables(Schema& s) {
    s.motion_path = {"planes.NAME.motion, meshes.NAME.motion, along a table", "", {
        field(&PathRow::path, {.key = "path", .text = "CSV file with the columns t x y z in SI units: seconds after `start` and the shift from where the boundary was placed; "
            "straight between rows, still before the first and after the last; relative to the scene file", .typical = "\"path.csv\""})}};
    s.mesh_file = {"meshes.NAME", "A boundary of triangles. Both sides are solid: a particle stays on the side from which it came.", {
        field(&MeshRow::file, {.key = "file", .text = "STL (text or binary) or OBJ; relative to the scene file", .typical = "\"funnel.stl\"", .required = true})}};
    s.mesh = {"meshes.NAME, material and place", "Scaled first, then turned, then shifted.", {
        field(&Mesh::material, {.key = "material", .text = "name of its material", .required = true}),
        field(&Mesh::scale, {.key = "scale", .text = "metres a unit of the file; 0.001 for a file in millimetres", .range = positive, .typical = "1"}),
        field(&Mesh::rotation, {.key = "rotation", .text = "angles about the x, then the y, then the z axis of the world, through the file's origin", .unit = unit::angle, .typical = "[\"90 deg\", 0, 0]"}),
        field(&Mesh::translation, {.key = "translation", .text = "shift", .unit = unit::length, .typical = "[0, 0, 1]"})}};
    s.terrain_files = {"terrain", "The ground as a grid of elevations; particles live above it.", {
        field(&TerrainRow::after, {.key = "after", .text = "file with the ground: an ESRI ASCII grid, or anything GDAL reads where this build has it; relative to the scene file", .typical = "\"after.asc\"", .required = true}),
        field(&TerrainRow::before, {.key = "before", .text = "file with the surface before the slide, on the same nodes: particles of type \"release\" fill what lies between", .typical = "\"before.asc\""})}};
    s.terrain = {"terrain, material and shape", "", {
        field(&Terrain::material, {.key = "material", .text = "name of its material", .required = true}),
        field(&Terrain::smooth, {.key = "smooth", .text = "1: two facets a cell; n: every cell is first cut into n x n by cubic interpolation, which rounds the edges", .range = {1, 64}, .typical = "4"}),
        field(&Terrain::edge, {.key = "edge", .text = "open: particles may leave the grid; walled: upright planes stand round it", .choices = {"open", "walled"}})}};
}

void add_stream_tables(Schema& s) {
    s.inlet = {"streams.NAME", "Particles that appear during the run, apart from all others, in a box or in a layer in front of a surface. What finds no place waits for the next insertion.", {
        field(&InletRow::type, {.key = "type", .text = "where they appear", .choices = {"box", "surface"}, .required = true})}};
    s.stream = {"streams.NAME, every type", "Their radii: see `size`.", {
        field(&ParticleStream::material, {.key = "material", .text = "name of their material", .required = true}),
        field(&ParticleStream::rate, {.key = "rate", .text = "particles a second, or mass a second as text: \"2 kg/s\"", .unit = unit::per_time, .range = positive, .typical = "500", .required = true}),
        field(&ParticleStream::total, {.key = "total", .text = "particles, or mass as text, \"50 kg\", after which the stream ends", .range = positive, .typical = "20000"}),
        field(&ParticleStream::start, {.key = "start", .text = "when it starts", .unit = unit::time, .range = non_negative, .typical = "0 s"}),
        field(&ParticleStream::stop, {.key = "stop", .text = "when it stops", .unit = unit::time, .range = non_negative, .typical = "5 s", .fallback = "never"}),
        field(&ParticleStream::velocity, {.key = "velocity", .text = "of every particle when it appears", .unit = unit::speed, .typical = "[0, 0, -1]"}),
        field(&ParticleStream::velocity_spread, {.key = "velocity_spread", .text = "each component is drawn evenly from velocity - spread to velocity + spread", .unit = unit::speed, .range = non_negative, .typical = "[0.1, 0.1, 0]"}),
        field(&ParticleStream::angular_velocity, {.key = "angular_velocity", .text = "of every particle when it appears", .unit = unit::rotation}),
        field(&ParticleStream::interval, {.key = "interval", .text = "time between two insertions; 0: a quarter of the time in which a particle crosses the inlet", .unit = unit::time, .range = non_negative, .typical = "0.05 s"}),
        field(&ParticleStream::attempts, {.key = "attempts", .text = "places tried for a particle at an insertion; after ten particles in a row without a place the rest wait", .range = {1, 1e6}, .typical = "100"})}};
    s.inlet_box = {"streams.NAME, type = \"box\"", "Spheres appear wholly inside the box; along a periodic axis that it spans, it goes on at the other end.", {
        field(&InletBoxRow::lower, {.key = "lower", .text = "lower corner of the box", .unit = unit::length, .required = true}),
        field(&InletBoxRow::upper, {.key = "upper", .text = "upper corner of the box", .unit = unit::length, .required = true})}};
    s.inlet_surface = {"streams.NAME, type = \"surface\"", "Spheres appear wholly inside the layer that the surface sweeps on the way of the velocity (of gravity where there is none). Needs one of mesh and file.", {
        field(&InletSurfaceRow::mesh, {.key = "mesh", .text = "name of a mesh of the scene; the inlet moves with it", .typical = "\"lid\""}),
        field(&InletSurfaceRow::file, {.key = "file", .text = "STL or OBJ of a surface that is no boundary; relative to the scene file", .typical = "\"inlet.stl\""}),
        field(&InletSurfaceRow::depth, {.key = "depth", .text = "thickness of the layer along the way", .unit = unit::length, .range = positive, .typical = "0.1 m", .required = true}),
        field(&InletSurfaceRow::lower, {.key = "lower", .text = "only the facets wholly inside a box: its lower corner", .unit = unit::length}),
        field(&InletSurfaceRow::upper, {.key = "upper", .text = "its upper corner", .unit = unit::length})}};
    s.inlet_file = {"streams.NAME, place of a surface's own file", "As for `meshes.NAME`.", {s.mesh.fields[1], s.mesh.fields[2], s.mesh.fields[3]}};
    s.removal = {"removals.NAME", "Particles whose centre is in a region are taken out, counted, and listed in `removed.csv`.", {
        field(&Removal::region, {.key = "type", .text = "box; half_space; outside: everything outside the domain, which then is no limit", .choices = {"box", "half_space", "outside"}, .required = true}),
        field(&Removal::steps, {.key = "steps", .text = "steps between two looks", .range = {1, 1e9}, .typical = "100"})}};
    s.removal_box = {"removals.NAME, type = \"box\"", "", {
        field(&RemovalBoxRow::lower, {.key = "lower", .text = "lower corner of the box", .unit = unit::length, .required = true}),
        field(&RemovalBoxRow::upper, {.key = "upper", .text = "upper corner of the box", .unit = unit::length, .required = true})}};
    s.half_space = {"removals.NAME, type = \"half_space\"", "", {
        field(&Removal::point, {.key = "point", .text = "a point of the plane", .unit = unit::length, .typical = "[0, 0, -1]", .required = true}),
        field(&Removal::normal, {.key = "normal", .text = "towards what is taken out, any length", .typical = "[0, 0, -1]", .required = true})}};
}

Schema make_schema() {
    Schema s;
    add_run_tables(s);
    add_output_tables(s);
    add_material_tables(s);
    add_particle_tables(s);
    add_release_table(s);
    add_size_tables(s);
    add_plane_tables(s);
    add_surface_tables(s);
    add_stream_tables(s);
    return s;
}

}  // namespace

const Schema& schema() {
    static const Schema table = make_schema();
    return table;
}

}  // namespace grainray::scene
