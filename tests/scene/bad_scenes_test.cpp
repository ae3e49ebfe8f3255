// Wrong scenes: every message says where (file:line:column), which key, what it is, and what would be right.
#include <algorithm>

#include "scene_text.hpp"

namespace grainray::test {
namespace {

struct BadScene {
    std::string name;
    std::string text;
    std::string place;                  ///< line:column; of what toml++ itself rejects, the line
    std::vector<std::string> expected;  ///< parts of the message
};

void PrintTo(const BadScene& bad, std::ostream* out) { *out << bad.name; }

class BadScenes : public testing::TestWithParam<BadScene> {};

TEST_P(BadScenes, MessageNamesPlaceKeyAndRemedy) {
    const BadScene& bad = GetParam();
    const std::string message = parse_error(bad.text);
    EXPECT_TRUE(message.starts_with("test.toml:" + bad.place + ":")) << "not at " << bad.place << ": " << message;
    for (const auto& part : bad.expected) EXPECT_NE(message.find(part), std::string::npos) << "no '" << part << "' in: " << message;
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 0) << message;
}

/// A group below with_grain; its header is line 7, its lines start at 8.
std::string group(const std::string& lines) { return with_grain + "[particles.g]\n" + lines; }
std::string lattice(const std::string& lines) {
    return group("type = \"lattice\"\nmaterial = \"grain\"\norigin = [0, 0, 0]\n" + lines);  // lines start at 11
}
const std::string count = "count = [2, 2, 2]\n", spacing = "spacing = [1, 1, 1]\n", radius = "radius = 0.1\n";
std::string fill(const std::string& lines) {
    return group("type = \"fill\"\nmaterial = \"grain\"\nlower = [0, 0, 0]\nupper = [1, 1, 1]\n" + lines);  // lines start at 12
}
std::string list(const std::string& lines) { return group("type = \"list\"\nmaterial = \"grain\"\n" + lines); }          // at 10
std::string plane(const std::string& lines) { return with_grain + "[planes.p]\nmaterial = \"grain\"\n" + lines; }       // at 9

const std::vector<BadScene> syntax{
    {"not_toml", "[simulation]\ndt = = 1\n", "2", {"not valid TOML"}},
    {"same_key_twice", "[simulation]\ndt = 1\ndt = 2\n", "3", {"not valid TOML", "dt"}},
    {"empty", "", "1:1", {"key 'simulation.dt' is missing: time step", "a typical value is 1e-3 s"}},
    {"no_duration", "[simulation]\ndt = 1\n", "1:1", {"key 'simulation.duration' is missing", "10 s"}},
    {"unknown_table", minimal + "[materails.x]\n", "5:2", {"key 'materails': unknown key", "did you mean 'materials'?", "Allowed: contact, domain"}},
    {"unknown_key", minimal + "[contact]\nmixng = 1\n", "6:1", {"key 'contact.mixng'", "did you mean 'mixing'?", "Allowed: law, mass_damping, mixing"}},
    {"far_unknown_key", minimal + "[limits]\nzzzzzzzz = 1\n", "6:1", {"unknown key. Allowed: overlap, speed"}},
    {"table_wanted", "simulation = 3\n", "1:14", {"key 'simulation' = 3", "expected a table [simulation], found an integer"}},
    {"named_table_wanted", minimal + "[materials]\ndensity = 2000\n", "6:11", {"key 'materials.density' = 2000", "[materials.NAME], found an integer"}},
    {"rows_wanted", minimal + "[pairs]\nfriction = 1\n", "5:1", {"key 'pairs'", "expected rows [[pairs]], found a table"}},
};

const std::vector<BadScene> values{
    {"negative_dt", "[simulation]\ndt = -1\nduration = 1\n", "2:6", {"key 'simulation.dt' = -1: must be greater than 0 s (a typical value is 1e-3 s)"}},
    {"zero_dt", "[simulation]\ndt = 0\nduration = 1\n", "2:6", {"must be greater than 0 s"}},
    {"nan_dt", "[simulation]\ndt = nan\nduration = 1\n", "2:6", {"key 'simulation.dt' = nan", "finite"}},
    {"infinite_duration", "[simulation]\ndt = 1\nduration = inf\n", "3:12", {"key 'simulation.duration' = inf", "finite"}},
    {"negative_duration", "[simulation]\ndt = 1\nduration = -2.5\n", "3:12", {"at least 0 s"}},
    {"too_many_steps", "[simulation]\ndt = 1e-12\nduration = 1e6\n", "2:6", {"key 'simulation.dt'", "1e+18 steps", "1e15"}},
    {"dt_is_an_array", "[simulation]\ndt = [1]\nduration = 1\n", "2:6", {"= [1]: expected a number, found an array"}},
    {"dt_is_a_date", "[simulation]\ndt = 2020-01-01\nduration = 1\n", "2:6", {"found a date"}},
    {"wrong_dimension", "[simulation]\ndt = \"5 kg\"\nduration = 1\n", "2:6", {"unit 'kg' has the wrong dimension", "accepted units: s, ms, us, min, h"}},
    {"unknown_unit", "[simulation]\ndt = \"5 sec\"\nduration = 1\n", "2:6", {"unknown unit 'sec'", "s, ms"}},
    {"unknown_subtable", minimal + "[simulation.x]\n", "5:13", {"key 'simulation.x': unknown key"}},
    {"gravity_of_two", "[simulation]\ndt = 1\nduration = 1\ngravity = [0, -10]\n", "4:11", {"array of 3 values", "found 2"}},
    {"gravity_unit", "[simulation]\ndt = 1\nduration = 1\ngravity = [0, 0, \"10 m/s\"]\n", "4:18", {"key 'simulation.gravity[2]'", "accepted units: m/s^2"}},
    {"seed_fraction", "[simulation]\ndt = 1\nduration = 1\nseed = 1.5\n", "4:8", {"expected an integer, found a number"}},
    {"seed_negative", "[simulation]\ndt = 1\nduration = 1\nseed = -1\n", "4:8", {"at least 0"}},
    {"method", "[simulation]\ndt = 1\nduration = 1\nmethod = \"den\"\n", "4:10", {"unknown value; did you mean 'dem'? Allowed: dem"}},
    {"mixing", minimal + "[contact]\nmixing = \"walls\"\n", "6:10", {"did you mean 'wall'?", "Allowed: series, wall"}},
    {"mass_damping", minimal + "[contact]\nmass_damping = 2\n", "6:16", {"at least 0 and at most 1", "0.1"}},
    {"frame_field", minimal + "[output]\nfields = [\"speeds\", \"id\"]\n", "6:11", {"key 'output.fields[0]' = \"speeds\"", "Allowed: radius, velocity"}},
    {"color_range", minimal + "[render]\ncolor_minimum = 2\ncolor_maximum = 1\n", "7:17", {"greater than color_minimum (2)"}},
    {"camera_up", minimal + "[render.camera]\nup = [0, 0, 0]\n", "6:6", {"key 'render.camera.up'", "zero vector"}},
    {"field_of_view", minimal + "[render.camera]\nfield_of_view = 180\n", "6:17", {"greater than 0 deg and less than 180 deg"}},
    {"periodic_without_box", minimal + "[domain]\nperiodic = [false, true, false]\n", "6:12", {"axis y is periodic", "'lower' and 'upper'"}},
    {"periodic_not_boolean", minimal + "[domain]\nperiodic = [0, 1, 0]\n", "6:13", {"key 'domain.periodic[0]' = 0", "expected true or false"}},
    {"plane_across_periodic", minimal + "[domain]\nperiodic = [false, true, false]\nlower = [0, 0, 0]\nupper = [1, 1, 1]\n[materials.a]\n[planes.p]\nmaterial = \"a\"\npoint = [0, 0, 0]\nnormal = [0, 1, 1]\n", "13:10", {"key 'planes.p.normal'", "periodic axis y", "domain.periodic"}},
    {"half_a_box", minimal + "[domain]\nlower = [0, 0, 0]\n", "6:9", {"a box needs both corners; add 'upper'"}},
    {"box_inside_out", minimal + "[domain]\nlower = [0, 0, 2]\nupper = [1, 1, 2]\n", "7:9", {"key 'domain.upper'", "greater than 'lower' along z (2 m)"}},
    {"friction_unit", minimal + "[materials.a]\nfriction = \"0.5 N\"\n", "6:12", {"wrong dimension", "no unit"}},
    {"zero_stiffness", minimal + "[materials.a]\nnormal_stiffness = 0\n", "6:20", {"greater than 0 N/m", "1e5 N/m"}},
    {"density_text", minimal + "[materials.a]\ndensity = \"heavy\"\n", "6:11", {"expected a number", "accepted units: kg/m^3, g/cm^3"}},
    {"pair_unknown_material", with_grain + "[[pairs]]\nmaterials = [\"grain\", \"grian\"]\n", "8:13", {"unknown material 'grian'", "did you mean 'grain'?"}},
    {"pair_twice", with_grain + "[materials.w]\n[[pairs]]\nmaterials = [\"grain\", \"w\"]\n[[pairs]]\nmaterials = [\"w\", \"grain\"]\n", "11:13", {"has a row already"}},
    {"pair_of_one", with_grain + "[[pairs]]\nmaterials = [\"grain\"]\n", "8:13", {"array of 2", "found 1"}},
};

const std::vector<BadScene> particles{
    {"no_type", group("material = \"grain\"\n"), "7:1", {"key 'particles.g.type' is missing", "one of lattice, list, file, fill, release"}},
    {"wrong_type", group("type = \"latice\"\n"), "8:8", {"did you mean 'lattice'?"}},
    {"no_materials", minimal + "[particles.g]\ntype = \"list\"\nmaterial = \"m\"\npositions = []\nradii = 1\n", "7:12", {"the scene has none", "[materials.m]"}},
    {"lattice_without_radius", lattice(count + spacing), "7:1", {"key 'particles.g.radius' is missing"}},
    {"negative_count", lattice("count = [2, -1, 2]\n" + spacing + radius), "11:13", {"key 'particles.g.count[1]' = -1", "at least 0"}},
    {"huge_count", lattice("count = [2000, 2000, 2000]\n" + spacing + radius), "11:9", {"8e+09 particles are too many", "2^31"}},
    {"zero_spacing", lattice(count + "spacing = [1, 1, 0]\n" + radius), "12:18", {"key 'particles.g.spacing[2]' = 0", "greater than 0 m"}},
    {"negative_jitter", lattice(count + spacing + radius + "jitter = [-0.1, 0, 0]\n"), "14:11", {"at least 0 m"}},
    {"key_of_another_type", lattice(count + spacing + radius + "solid_fraction = 0.3\n"), "14:1", {"not a key of type = \"lattice\", size = \"fixed\"", "Allowed:"}},
    {"key_of_another_law", lattice(count + spacing + radius + "size = \"normal\"\n"), "13:1", {"key 'particles.g.radius'", "size = \"normal\"", "radius_mean"}},
    {"uniform_without_limits", lattice(count + spacing + "size = \"uniform\"\n"), "7:1", {"'particles.g.radius_minimum' is missing"}},
    {"uniform_inside_out", lattice(count + spacing + "size = \"uniform\"\nradius_minimum = 2\nradius_maximum = 1\n"), "15:18", {"greater than radius_minimum (2 m)"}},
    {"normal_too_wide", lattice(count + spacing + "size = \"normal\"\nradius_mean = 1\nradius_deviation = 0.5\n"), "7:1", {"particles.g.radius_minimum", "not positive"}},
    {"weights_do_not_match", lattice(count + spacing + "size = \"table\"\nradii = [1, 2]\nweights = [1]\n"), "15:11", {"1 values for 2 radii"}},
    {"weights_all_zero", lattice(count + spacing + "size = \"table\"\nradii = [1, 2]\nweights = [0, 0]\n"), "15:11", {"greater than 0"}},
    {"fill_without_goal", fill(radius), "7:1", {"key 'particles.g.count'", "one of count and solid_fraction"}},
    {"fill_with_two_goals", fill(radius + "count = 3\nsolid_fraction = 0.1\n"), "14:18", {"not both"}},
    {"fill_too_dense", fill(radius + "solid_fraction = 0.9\n"), "13:18", {"at most 0.74"}},
    {"fill_box_inside_out", group("type = \"fill\"\nmaterial = \"grain\"\nlower = [0, 1, 0]\nupper = [1, 1, 1]\ncount = 1\n" + radius), "11:9", {"along y (1 m)"}},
    {"fill_outside_domain", fill(radius + "count = 1\n[domain]\nlower = [0, 0, 0]\nupper = [1, 0.5, 1]\n"), "11:9", {"leaves the domain along y (0 to 0.5 m)"}},
    {"list_radii", list("positions = [[0, 0, 0]]\nradii = [1, 2]\n"), "11:9", {"has 2 values for 1 positions"}},
    {"list_zero_radius", list("positions = [[0, 0, 0]]\nradii = 0\n"), "11:9", {"greater than 0 m"}},
    {"list_velocities", list("positions = [[0, 0, 0]]\nradii = 1\nvelocities = [[1, 0, 0], [1, 0, 0]]\n"), "12:14", {"2 values for 1 positions"}},
    {"list_nan", list("positions = [[0, nan, 0]]\nradii = 1\n"), "10:18", {"key 'particles.g.positions[0][1]' = nan", "finite"}},
    {"list_flat", list("positions = [0, 0, 0]\nradii = 1\n"), "10:14", {"key 'particles.g.positions[0]' = 0", "array of 3 values"}},
    {"file_without_path", group("type = \"file\"\nmaterial = \"grain\"\n"), "7:1", {"key 'particles.g.path' is missing"}},
    {"plane_without_material", with_grain + "[planes.p]\n", "7:1", {"key 'planes.p.material' is missing"}},
    {"plane_material", with_grain + "[planes.p]\nmaterial = \"grains\"\n", "8:12", {"did you mean 'grain'?"}},
    {"zero_normal", plane("normal = [0, 0, 0]\n"), "9:10", {"key 'planes.p.normal' = [0, 0, 0]", "zero vector"}},
    {"zero_axis", plane("motion.rotation = {axis = [0, 0, 0], point = [0, 0, 0], rate = 1}\n"), "9:27", {"'planes.p.motion.rotation.axis'"}},
    {"rotation_without_rate", plane("motion.rotation = {axis = [0, 0, 1], point = [0, 0, 0]}\n"), "9:19", {"'planes.p.motion.rotation.rate' is missing", "10 rpm"}},
    {"rate_in_hertz", plane("motion.rotation = {axis = [0, 0, 1], point = [0, 0, 0], rate = \"2 Hz\"}\n"), "9:64", {"wrong dimension", "rad/s, deg/s, rpm"}},
    {"stop_before_start", plane("motion = {start = 2, stop = 1}\n"), "9:29", {"greater than start (2 s)"}},
    {"motion_key", plane("motion = {speed = 2}\n"), "9:11", {"key 'planes.p.motion.speed': unknown key", "oscillation, path, rotation, start, stop, velocity"}},
};

/// A stream below with_grain; its header is line 7, its lines start at 12.
std::string stream(const std::string& lines) {
    return with_grain + "[streams.s]\nmaterial = \"grain\"\nvelocity = [0, 0, -1]\ndepth = 1\ntype = \"surface\"\n" + lines;
}
/// The same with a box of 1 x 1 x 1 m; lines start at 13.
std::string box_stream(const std::string& lines) {
    return with_grain + "[streams.s]\nmaterial = \"grain\"\nvelocity = [0, 0, -1]\ntype = \"box\"\nlower = [0, 0, 0]\nupper = [1, 1, 1]\n" + lines;
}
std::string removal(const std::string& lines) { return with_grain + "[removals.r]\n" + lines; }  // at 8
const std::string rate = "rate = 100\n";

const std::vector<BadScene> exchanges{
    {"stream_without_type", with_grain + "[streams.s]\nmaterial = \"grain\"\n", "7:1", {"key 'streams.s.type' is missing: where they appear (one of box, surface)"}},
    {"stream_without_rate", box_stream(radius), "7:1", {"key 'streams.s.rate' is missing", "a typical value is 500"}},
    {"stream_zero_rate", box_stream(radius + "rate = 0\n"), "14:8", {"key 'streams.s.rate' = 0: must be greater than 0 1/s"}},
    {"stream_rate_unit", box_stream(radius + "rate = \"2 kg\"\n"), "14:8", {"a number of particles a second, or a mass as text in kg/s, g/s, kg/h, t/h"}},
    {"stream_total_unit", box_stream(radius + rate + "total = \"2 m\"\n"), "15:9", {"a number of particles, or a mass as text in kg, g, mg, t"}},
    {"stream_without_radius", box_stream(rate), "7:1", {"key 'streams.s.radius' is missing"}},
    {"stream_material", box_stream(radius + rate + "friction = 1\n"), "15:1", {"key 'streams.s.friction': not a key of type = \"box\", size = \"fixed\""}},
    {"stream_unknown_material", "[simulation]\ndt = 1\nduration = 1\n[materials.a]\n[streams.s]\ntype = \"box\"\nmaterial = \"b\"\nrate = 1\n", "7:12", {"unknown material 'b'"}},
    {"stream_zero_volume", with_grain + "[streams.s]\nmaterial = \"grain\"\ntype = \"box\"\nlower = [0, 0, 1]\nupper = [1, 1, 1]\n" + rate + radius, "11:9", {"key 'streams.s.upper'", "greater than 'lower' along z (1 m)"}},
    {"stream_outside_domain", box_stream(radius + rate + "[domain]\nlower = [0, 0.5, 0]\nupper = [2, 2, 2]\n"), "11:9", {"key 'streams.s.lower'", "leaves the domain along y (0.5 to 2 m)"}},
    {"stream_grains_too_large", box_stream(rate + "radius = 0.6\n"), "12:9", {"key 'streams.s.upper'", "1 m wide along x and the largest particle 1.2 m"}},
    {"stream_some_grains_too_large", box_stream(rate + "size = \"uniform\"\nradius_minimum = 0.1\nradius_maximum = 0.51\n"), "12:9", {"the largest particle 1.02 m"}},
    {"stream_stop", box_stream(radius + rate + "start = 2\nstop = 2\n"), "16:8", {"key 'streams.s.stop'", "greater than start (2 s)"}},
    {"stream_stays_where_it_is", "[simulation]\ndt = 1\nduration = 1\ngravity = [0, 0, 0]\n[materials.a]\n[streams.s]\ntype = \"box\"\nmaterial = \"a\"\nrate = 1\n", "6:1", {"key 'streams.s.velocity': nothing carries the particles out"}},
    {"stream_attempts", box_stream(radius + rate + "attempts = 0\n"), "15:12", {"at least 1"}},
    {"stream_spread", box_stream(radius + rate + "velocity_spread = [-1, 0, 0]\n"), "15:20", {"key 'streams.s.velocity_spread[0]' = -1: must be at least 0 m/s"}},
    {"stream_without_surface", stream(radius + rate), "7:1", {"key 'streams.s.mesh'", "one of mesh (of the scene) and file (no boundary)"}},
    {"stream_with_two_surfaces", stream(radius + rate + "mesh = \"m\"\nfile = \"f.stl\"\n"), "15:8", {"give mesh or file, not both"}},
    {"stream_mesh_of_none", stream(radius + rate + "mesh = \"m\"\n"), "14:8", {"unknown mesh 'm': the scene has none; add a table [meshes.m], or give 'file'"}},
    {"stream_mesh_not_found", stream(radius + rate + "mesh = \"lit\"\n[meshes.lid]\nfile = \"lid.stl\"\nmaterial = \"grain\"\n"), "14:8", {"unknown mesh 'lit'; did you mean 'lid'? Defined: lid"}},
    {"stream_mesh_has_a_place", stream(radius + rate + "mesh = \"lid\"\nscale = 2\n[meshes.lid]\nfile = \"lid.stl\"\nmaterial = \"grain\"\n"), "15:9", {"key 'streams.s.scale'", "mesh 'lid' has its own place; give it in [meshes.lid]"}},
    {"stream_layer_too_thin", stream("radius = 0.6\n" + rate + "file = \"a.stl\"\n"), "10:9", {"key 'streams.s.depth'", "the largest particle is 1.2 m wide; deepen the layer"}},
    {"stream_half_a_box", stream(radius + rate + "file = \"a.stl\"\nlower = [0, 0, 0]\n"), "15:9", {"a box needs both corners; add 'upper'"}},
    {"stream_of_two_kinds", stream(radius + rate + "file = \"a.stl\"\ndept = 1\n"), "15:1", {"not a key of type = \"surface\", size = \"fixed\"", "did you mean 'depth'"}},
    {"removal_without_type", removal("steps = 10\n"), "7:1", {"key 'removals.r.type' is missing", "one of box, half_space, outside"}},
    {"removal_box_inside_out", removal("type = \"box\"\nlower = [0, 0, 0]\nupper = [1, -1, 1]\n"), "10:9", {"key 'removals.r.upper'", "greater than 'lower' along y (0 m)"}},
    {"removal_box_without_corner", removal("type = \"box\"\nlower = [0, 0, 0]\n"), "7:1", {"key 'removals.r.upper' is missing"}},
    {"removal_of_another_type", removal("type = \"box\"\nnormal = [0, 0, 1]\n"), "9:1", {"not a key of type = \"box\""}},
    {"removal_zero_normal", removal("type = \"half_space\"\npoint = [0, 0, 0]\nnormal = [0, 0, 0]\n"), "10:10", {"zero vector"}},
    {"removal_outside_of_nothing", removal("type = \"outside\"\n"), "8:8", {"there is no domain to be outside of; give domain.lower and domain.upper"}},
    {"removal_never_looks", removal("type = \"outside\"\nsteps = 0\n"), "9:9", {"key 'removals.r.steps' = 0: must be at least 1"}},
};

std::string name_of(const testing::TestParamInfo<BadScene>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Syntax, BadScenes, testing::ValuesIn(syntax), name_of);
INSTANTIATE_TEST_SUITE_P(Values, BadScenes, testing::ValuesIn(values), name_of);
INSTANTIATE_TEST_SUITE_P(Exchanges, BadScenes, testing::ValuesIn(exchanges), name_of);
INSTANTIATE_TEST_SUITE_P(Particles, BadScenes, testing::ValuesIn(particles), name_of);

TEST(BadFile, IsNamed) {
    for (const std::string path : {"/nowhere/at/all.toml", "/"}) {
        try {
            load_scene(path);
            FAIL() << path;
        } catch (const InputError& e) {
            EXPECT_TRUE(std::string(e.what()).starts_with(path + ": ")) << e.what();
        }
    }
}

}  // namespace
}  // namespace grainray::test
