// TOML -> Scene: every table, units, defaults, the pair table.
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <numbers>

#include "folders.hpp"
#include "scene_text.hpp"

namespace grainray::test {
namespace {

TEST(Parse, DefaultsAreThoseOfTheStructs) {
    const Scene scene = parse(minimal), fresh;
    EXPECT_EQ(scene.dt, 1e-3);
    EXPECT_EQ(scene.duration, 1.0);
    EXPECT_EQ(scene.steps(), 1000u);
    EXPECT_EQ(scene.method, "dem");
    EXPECT_EQ(scene.gravity, fresh.gravity);
    EXPECT_EQ(scene.contact.mixing, Mixing::wall);
    EXPECT_EQ(scene.search.backend, "auto");
    EXPECT_EQ(scene.limits.overlap, fresh.limits.overlap);
    EXPECT_EQ(scene.render.width, 1280);
    EXPECT_FALSE(scene.domain.box);
    EXPECT_TRUE(scene.particles.empty());
    EXPECT_EQ(scene.file, "test.toml");
    EXPECT_EQ(scene.source, minimal);
}

TEST(Parse, EveryTableReachesItsStruct) {
    const Scene s = parse(R"(title = "all"
simulation = { method = "dem", dt = "0.5 ms", duration = 2, gravity = [0, "-981 cm/s^2", 0], seed = 7 }
domain = { lower = [0, 0, 0], upper = [1, "2 m", 3], periodic = [true, false, true] }
contact = { law = "linear", mixing = "series", mass_damping = 0.1 }
search = { backend = "rays", skin = 0.2, interval = 30, trigger = "published", rays = { variant = "published" } }
output = { frames = 0.1, history = "10 ms", checkpoints = 1, format = "csv", fields = ["velocity", "id"] }
limits = { overlap = 0.5, speed = "36 km/h" }
[render]
color_by = "coordination"
color_minimum = 1
color_maximum = 6
width = 640
height = 480
[render.camera]
eye = [5, 0, 1]
target = [0, 0, 1]
up = [0, 0, 2]
field_of_view = "0.5 rad"
)");
    EXPECT_EQ(s.title, "all");
    EXPECT_DOUBLE_EQ(s.dt, 5e-4);
    EXPECT_DOUBLE_EQ(s.gravity.y, -9.81);
    EXPECT_EQ(s.seed, 7u);
    ASSERT_TRUE(s.domain.box);
    EXPECT_EQ(s.domain.box->upper, (Vec3d{1, 2, 3}));
    EXPECT_EQ(s.domain.periodic, (std::array{true, false, true}));
    EXPECT_EQ(s.contact.mixing, Mixing::series);
    EXPECT_EQ(s.contact.mass_damping, 0.1);
    EXPECT_EQ(s.search.backend, "rays");
    EXPECT_EQ(s.search.rays.variant, "published");
    EXPECT_EQ(s.search.trigger, Trigger::published);
    EXPECT_EQ(s.search.skin, 0.2);
    EXPECT_EQ(s.search.interval, 30);
    EXPECT_DOUBLE_EQ(s.output.history, 0.01);
    EXPECT_EQ(s.output.format, "csv");
    EXPECT_EQ(s.output.fields, (std::vector<std::string>{"velocity", "id"}));
    EXPECT_DOUBLE_EQ(s.limits.speed, 10);
    EXPECT_EQ(s.render.color_by, "coordination");
    EXPECT_EQ(s.render.color_maximum, 6.0);
    EXPECT_EQ(s.render.height, 480);
    EXPECT_EQ(s.render.camera.up, (Vec3d{0, 0, 1}));
    EXPECT_NEAR(s.render.camera.field_of_view, 0.5 * 180 / std::numbers::pi, 1e-12);
}

TEST(Parse, GroupsAndPlanesKeepTheOrderOfTheFile) {
    const Scene s = parse(minimal + R"([materials.steel]
density = "7.8 g/cm^3"
[materials.glass]
[particles.z]
type = "list"
material = "glass"
positions = [[0, 0, 1], [0, 0, 2]]
radii = ["10 mm", 0.02]
angular_velocity = [0, 0, "60 rpm"]
[particles.a]
type = "fill"
material = "steel"
lower = [0, 0, 0]
upper = [1, 1, 1]
solid_fraction = 0.1
size = "normal"
radius_mean = 0.1
radius_deviation = 0.01
[planes.top]
material = "steel"
normal = [0, 0, -3]
[planes.bottom]
material = "steel"
)");
    ASSERT_EQ(s.materials.size(), 2u);
    EXPECT_EQ(s.materials[0].name, "steel");
    EXPECT_DOUBLE_EQ(s.materials[0].density, 7800);
    ASSERT_EQ(s.particles.size(), 2u);
    EXPECT_EQ(s.particles[0].name, "z");
    EXPECT_DOUBLE_EQ(s.particles[0].angular_velocity.z, 2 * std::numbers::pi);
    EXPECT_DOUBLE_EQ(std::get<ParticleList>(s.particles[0].placement).radii[0], 0.01);
    EXPECT_DOUBLE_EQ(s.particles[1].size.minimum, 0.07);
    EXPECT_DOUBLE_EQ(s.particles[1].size.maximum, 0.13);
    EXPECT_EQ(s.planes[0].name, "top");
    EXPECT_EQ(s.planes[0].normal, (Vec3d{0, 0, -1}));
    EXPECT_EQ(s.planes[1].normal, (Vec3d{0, 0, 1}));
}

double dt_of(const std::string& value) { return parse("[simulation]\nduration = 1\ndt = " + value + "\n").dt; }

TEST(Units, ConvertToTheUnitOfTheField) {
    EXPECT_DOUBLE_EQ(dt_of("\"1 ms\""), 1e-3);
    EXPECT_DOUBLE_EQ(dt_of("\"250us\""), 2.5e-4);
    EXPECT_DOUBLE_EQ(dt_of("\"0.5 s\""), 0.5);
    EXPECT_DOUBLE_EQ(dt_of("\"2 min\""), 120);
    EXPECT_DOUBLE_EQ(dt_of("\"1e-3\""), 1e-3);  // a number in quotes is a number
}

TEST(Units, CompoundUnitsAndAngles) {
    const Scene s = parse(minimal + R"([materials.m]
density = "1.5 t/m3"
normal_stiffness = "0.1 kN/mm"
tangential_stiffness = "2e5 kg/s^2"
friction = "40 %"
[planes.p]
material = "m"
point = ["3 mm", "-2 cm", "1e-3 km"]
[planes.p.motion]
velocity = ["36 km/h", "1 m*s^-1", 0]
start = "100 ms"
[planes.p.motion.rotation]
axis = [0, 2, 0]
point = [0, 0, 0]
rate = "90 deg/s"
[planes.p.motion.oscillation]
amplitude = ["5 mm", 0, 0]
frequency = "2 Hz"
phase = "30 deg"
)");
    EXPECT_DOUBLE_EQ(s.materials[0].density, 1500);
    EXPECT_DOUBLE_EQ(s.materials[0].normal_stiffness, 1e5);
    EXPECT_DOUBLE_EQ(s.materials[0].tangential_stiffness, 2e5);
    EXPECT_DOUBLE_EQ(s.materials[0].friction, 0.4);
    EXPECT_DOUBLE_EQ(s.planes[0].point.x, 0.003);
    EXPECT_DOUBLE_EQ(s.planes[0].point.y, -0.02);
    EXPECT_DOUBLE_EQ(s.planes[0].point.z, 1);
    const Motion& m = s.planes[0].motion;
    EXPECT_DOUBLE_EQ(m.velocity.x, 10);
    EXPECT_DOUBLE_EQ(m.velocity.y, 1);
    EXPECT_DOUBLE_EQ(m.start, 0.1);
    EXPECT_EQ(m.rotation_axis, (Vec3d{0, 1, 0}));
    EXPECT_DOUBLE_EQ(m.rotation_rate, std::numbers::pi / 2);
    EXPECT_DOUBLE_EQ(m.oscillation_frequency, 2);
    EXPECT_DOUBLE_EQ(m.oscillation_phase, std::numbers::pi / 6);
}

const std::string two_materials = minimal + R"([materials.grain]
normal_stiffness = 1e5
tangential_stiffness = 1e5
friction = 0.5
normal_damping = 0.4
[materials.wall]
normal_stiffness = 1e7
tangential_stiffness = 2e6
friction = 1.0
normal_damping = 0.6
)";

TEST(ContactParameters, WallRuleTakesTheBoundarysValuesAndSeriesBetweenParticles) {
    const Scene s = parse(two_materials);
    const MaterialPair wall = contact_parameters(s, 0, 1, true), grains = contact_parameters(s, 0, 1, false);
    EXPECT_EQ(wall.normal_stiffness, 1e7);
    EXPECT_EQ(wall.tangential_stiffness, 2e6);
    EXPECT_EQ(wall.friction, 1.0);
    EXPECT_EQ(wall.normal_damping, 0.6);
    EXPECT_DOUBLE_EQ(grains.normal_stiffness, 2 * 1e5 * 1e7 / (1e5 + 1e7));
    EXPECT_EQ(grains.friction, 0.5);
    EXPECT_DOUBLE_EQ(grains.normal_damping, 0.5);
    EXPECT_EQ(contact_parameters(s, 0, 0, false).normal_stiffness, 1e5);
}

TEST(ContactParameters, SeriesRuleMixesWallsToo) {
    const Scene s = parse(two_materials, {"contact.mixing=series"});
    const MaterialPair wall = contact_parameters(s, 0, 1, true);
    EXPECT_NEAR(wall.normal_stiffness, 1.98e5, 20);
    EXPECT_EQ(wall.friction, 0.5);
}

TEST(ContactParameters, APairRowReplacesOnlyWhatItGives) {
    const Scene s = parse(
        two_materials + "[[pairs]]\nmaterials = [\"wall\", \"grain\"]\nfriction = 0\nnormal_stiffness = \"3 kN/m\"\n");
    for (const bool boundary : {true, false}) {
        const MaterialPair pair = contact_parameters(s, 0, 1, boundary);
        EXPECT_EQ(pair.friction, 0);
        EXPECT_EQ(pair.normal_stiffness, 3000);
        EXPECT_EQ(pair.normal_damping, boundary ? 0.6 : 0.5);
        EXPECT_EQ(pair.materials[0], "grain");
    }
    EXPECT_EQ(contact_parameters(s, 0, 0, false).friction, 0.5);
}

TEST(Parse, StreamsAndRemovals) {
    const Scene s = parse(with_grain + R"(
[streams.feed]
type = "box"
material = "grain"
rate = "7.2 t/h"
total = 500
lower = [0, 0, 0]
upper = ["50 cm", 1, 1]
radius = "5 mm"
start = "1 min"
velocity = [0, 0, -1]
velocity_spread = [0.1, 0, 0]
[streams.lid]
type = "surface"
material = "grain"
rate = "120 1/min"
total = "3 t"
file = "lid.stl"
scale = 0.001
depth = 0.1
lower = [0, 0, 0]
upper = [1, 1, 0]
size = "uniform"
radius_minimum = 0.01
radius_maximum = 0.02
[domain]
lower = [-5, -5, -5]
upper = [5, 5, 5]
[removals.below]
type = "half_space"
point = [0, 0, -1]
normal = [0, 0, -2]
[removals.rest]
type = "outside"
steps = 7
[removals.bin]
type = "box"
lower = [0, 0, 0]
upper = [1, 1, 9]
)");
    ASSERT_EQ(s.streams.size(), 2u);
    const ParticleStream &feed = s.streams[0], &lid = s.streams[1];
    EXPECT_EQ(feed.name, "feed");
    EXPECT_DOUBLE_EQ(feed.rate.mass, 2);
    EXPECT_EQ(feed.rate.particles, 0);
    EXPECT_EQ(feed.total.particles, 500);
    EXPECT_EQ(feed.start, 60);
    EXPECT_EQ(feed.stop, std::numeric_limits<double>::infinity());
    EXPECT_EQ(std::get<Box>(feed.inlet).upper, (Vec3d{0.5, 1, 1}));
    EXPECT_EQ(feed.size.radius, 0.005);
    EXPECT_EQ(feed.velocity_spread.x, 0.1);
    EXPECT_EQ(feed.attempts, 100);
    EXPECT_DOUBLE_EQ(lid.rate.particles, 2);
    EXPECT_EQ(lid.total.mass, 3000);
    const auto& surface = std::get<InletSurface>(lid.inlet);
    EXPECT_EQ(surface.surface.file, "lid.stl");
    EXPECT_EQ(surface.surface.scale, 0.001);
    EXPECT_EQ(surface.depth, 0.1);
    EXPECT_EQ(surface.facets->upper.y, 1);
    EXPECT_EQ(largest_radius(lid.size), 0.02);
    EXPECT_EQ(smallest_radius(lid.size), 0.01);
    ASSERT_EQ(s.removals.size(), 3u);
    EXPECT_EQ(s.removals[0].normal, (Vec3d{0, 0, -1}));
    EXPECT_EQ(s.removals[0].steps, 100);
    EXPECT_EQ(s.removals[1].region, RemovalRegion::outside);
    EXPECT_EQ(s.removals[1].steps, 7);
    EXPECT_EQ(s.removals[2].box.upper.z, 9);
}

/// docs/scene.md holds schema_text() between two marks; GRAINRAY_UPDATE_DOCS=1 writes it there.
TEST(Schema, DocsHoldTheFieldTable) {
    const std::string path = project_folder() / "docs/scene.md", begin = "<!-- fields -->\n",
                      end = "<!-- end of fields -->";
    std::ifstream in(path);
    std::string page{std::istreambuf_iterator<char>(in), {}};
    const auto from = page.find(begin), to = page.find(end);
    ASSERT_TRUE(from != std::string::npos && to != std::string::npos) << path;
    const std::string table = page.substr(from + begin.size(), to - from - begin.size());
    if (std::getenv("GRAINRAY_UPDATE_DOCS") && table != schema_text())
        std::ofstream(path) << page.replace(from + begin.size(), table.size(), schema_text());
    else EXPECT_EQ(table, schema_text()) << "run this test with GRAINRAY_UPDATE_DOCS=1";
}

}  // namespace
}  // namespace grainray::test
