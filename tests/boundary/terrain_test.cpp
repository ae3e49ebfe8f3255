// Terrain: grids from files, refinement, what lies between two surfaces, outlines, edges, and particles that leave.
#include <filesystem>
#include <fstream>

#include "devices.hpp"
#include "meshes.hpp"
#include "surfaces/surfaces.hpp"

namespace grainray::test {
namespace {

namespace fs = std::filesystem;

class Folder : public ::testing::Test {
protected:
    fs::path folder = fs::temp_directory_path() / ("grainray_terrain_" + std::to_string(::getpid()));
    void SetUp() override { fs::create_directories(folder); }
    void TearDown() override { fs::remove_all(folder); }
    fs::path write(const std::string& name, const std::string& text) const {
        std::ofstream(folder / name) << text;
        return folder / name;
    }
    Scene scene(const std::string& rest) const {
        return parse_scene("[simulation]\ndt = 1e-3\nduration = 1\n[materials.rock]\n[terrain]\nmaterial = \"rock\"\n" + rest, (folder / "scene.toml").string());
    }
};

using GridFile = Folder;

TEST_F(GridFile, EsriAscii) {
    const auto file = write("a.asc", "NCOLS 3\nnrows 2\nxllcorner -10\nyllcorner 20\ncellsize 2\nNODATA_value -9999\n1 2 3\n4 -9999 6.5\n");
    const ElevationGrid g = surfaces::read_grid_file(file, "");
    EXPECT_EQ(g.columns, 3);
    EXPECT_EQ(g.rows, 2);
    EXPECT_EQ(g.x, -9);  // a height stands in the middle of its cell
    EXPECT_EQ(g.y, 21);
    EXPECT_EQ(g.at(0, 1), 1);  // the first row of the file is the northern one
    EXPECT_EQ(g.at(2, 0), 6.5);
    EXPECT_TRUE(std::isnan(g.at(1, 0)));
    surfaces::write_esri_grid(folder / "b.asc", g);
    const ElevationGrid again = surfaces::read_grid_file(folder / "b.asc", "");
    EXPECT_TRUE(again.same_nodes(g));
    EXPECT_EQ(again.at(2, 0), 6.5);
    EXPECT_TRUE(std::isnan(again.at(1, 0)));
    const auto centred = write("c.asc", "ncols 2\nnrows 2\nxllcenter 5\nyllcenter 6\ndx 1\ndy 3\n1 2 3 4\n");
    EXPECT_EQ(surfaces::read_grid_file(centred, "").x, 5);
    EXPECT_EQ(surfaces::read_grid_file(centred, "").dy, 3);
}

TEST(Grid, HeightsBetweenNodesAndRefinement) {
    ElevationGrid plane{5, 4, 100, 200, 2, 3, {}};
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 5; ++i) plane.heights.push_back(7 + 0.5 * 2 * i - 0.25 * 3 * j);
    const auto exact = [](double x, double y) { return 7 + 0.5 * (x - 100) - 0.25 * (y - 200); };
    ElevationGrid fine = plane.refined(4);
    EXPECT_EQ(fine.columns, 17);
    EXPECT_EQ(fine.rows, 13);
    for (const auto* g : {&plane, &fine})
        for (double x = 100; x <= 108; x += 0.37)
            for (double y = 200; y <= 209; y += 0.41) ASSERT_NEAR(g->height(x, y), exact(x, y), 1e-12);
    EXPECT_NEAR(plane.steepness(103.3, 204.1), std::sqrt(1 + 0.25 + 0.0625), 1e-12);
    EXPECT_TRUE(std::isnan(plane.height(99.9, 204)));
    ElevationGrid wave{33, 3, 0, 0, 1, 1, {}};
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 33; ++i) wave.heights.push_back(std::sin(0.5 * i));
    double coarse = 0, smooth = 0;
    for (double x = 3; x < 29; x += 0.1) {
        coarse = std::max(coarse, std::fabs(wave.height(x, 1) - std::sin(0.5 * x)));
        smooth = std::max(smooth, std::fabs(wave.refined(8).height(x, 1) - std::sin(0.5 * x)));
    }
    EXPECT_LT(smooth, coarse / 4);
}

ElevationGrid level(std::int64_t n, double z, double cell = 1) { return {n, n, 0, 0, cell, cell, std::vector<double>(static_cast<std::size_t>(n * n), z)}; }

Case on_terrain(ElevationGrid g) {
    Case c = empty_case();
    c.scene.terrain.emplace();
    c.scene.terrain->material = "wall";
    c.scene.terrain->after = std::move(g);
    return c;
}

class OnTerrain : public ::testing::TestWithParam<Device> {
protected:
    void SetUp() override { GRAINRAY_NEEDS(GetParam()); }
};

TEST_P(OnTerrain, ASlopeAnswersAsAPlane) {
    ElevationGrid slope = level(41, 0, 0.1);
    for (int j = 0; j < 41; ++j)
        for (int i = 0; i < 41; ++i) slope.heights[static_cast<std::size_t>(41 * j + i)] = 0.25 * 0.1 * i - 0.125 * 0.1 * j;
    Case terrain = on_terrain(slope), plane = empty_case();
    plane.plane("slope", {0, 0, 0}, Vec3d{-0.25, 0.125, 1} * (1 / std::sqrt(1.078125)));
    for (Case* c : {&terrain, &plane}) {
        c->scene.dt = 2e-4;
        c->scene.materials[1].normal_stiffness = 1e6;
        c->scene.materials[1].tangential_stiffness = 2e5;
        c->add({3, 1, 1.2}, 0.1, {0, 0.5, 0}, {1, 2, 3});
        c->add({3.2, 2, 0.7}, 0.05);
    }
    Simulation a = plane.start(GetParam()), b = terrain.start(GetParam());
    for (int k = 0; k < 60; ++k) {
        a.run(100);
        b.run(100);
        const Frame fa = a.frame(), fb = b.frame();
        for (std::size_t i = 0; i < 2; ++i) ASSERT_LT(length(fa.position[i] - fb.position[i]), 1e-3 * (0.3 + length(fa.position[i] - plane.initial.positions[i]))) << i << " " << k;
    }
    EXPECT_LT(b.frame().position[0].x, 2.5);  // it did roll
}

/// Equal piles in pits in the middle of a terrain of 3 km, at its rim and in between: no place is worse than another.
TEST_P(OnTerrain, PilesAreStillFarFromTheMiddleToo) {
    const double places[] = {-1498, -750, 0, 750, 1498};
    ElevationGrid pits{6001, 9, -1500, -2, 0.5, 0.5, std::vector<double>(6001 * 9, 1.0)};
    for (const double place : places)
        for (int j = 3; j <= 5; ++j)
            for (int i = -1; i <= 1; ++i) pits.heights[static_cast<std::size_t>(6001 * j + 2 * (place + 1500) + i)] = 0;
    Case c = on_terrain(pits);
    c.scene.dt = 2e-4;
    c.scene.contact.mass_damping = 0.5;
    c.scene.materials[1].normal_stiffness = 1e6;
    c.scene.materials[1].tangential_stiffness = 2e5;
    Dice dice(5);
    std::vector<Vec3d> pile;
    for (int i = 0; i < 36; ++i)
        pile.push_back({0.21 * (i % 4) - 0.315 + dice(0, 0.015), 0.21 * (i / 4 % 3) - 0.21 + dice(0, 0.015), 0.11 + 0.22 * (i / 12)});
    for (const double place : places)
        for (const Vec3d& x : pile) {
            Vec3d p;
            for (int a = 0; a < 3; ++a) p[a] = std::ldexp(std::round(std::ldexp(x[a], 24)), -24);  // exact wherever it stands
            c.add(p + Vec3d{place, 0, 0}, 0.1);
        }
    Simulation s = c.start(GetParam());
    s.run(40000);
    const Frame f = s.frame();
    double fastest[5] = {};
    for (std::size_t i = 0; i < f.size(); ++i) fastest[f.id[i] / pile.size()] = std::max(fastest[f.id[i] / pile.size()], double{length(f.velocity[i])});
    EXPECT_LT(fastest[2], 1e-5);  // later than 4 s: one grain rolls long, with little to stop it
    for (const int k : {0, 1, 3, 4}) EXPECT_EQ(fastest[k], fastest[2]) << places[k];
}

TEST_P(OnTerrain, ParticlesThatLeaveAreTakenOutAndListed) {
    Case c = on_terrain(level(6, 0));
    for (int k = 0; k < 5; ++k) c.add({2.5, 0.5 + k, 0.1}, 0.1, {k == 2 ? 0.0 : 4.0, 0, 0}, {0, k == 2 ? 0.0 : 40.0, 0});
    c.scene.terrain->after->heights[25] = NAN;  // a hole round (1, 4)
    c.add({1, 4.0, 0.5}, 0.1);
    Simulation whole = c.start(GetParam());
    whole.run(900);
    const Checkpoint middle = whole.checkpoint();
    whole.run(1100);
    EXPECT_EQ(whole.size(), 1u);
    ASSERT_EQ(whole.lost().size(), 5u);
    for (const LostParticle& p : whole.lost()) {
        EXPECT_EQ(p.step % 100, 0u);
        EXPECT_TRUE(p.id == 5 ? p.position.z < -0.1 : p.position.x > 5.1) << p.id;
    }
    EXPECT_EQ(whole.frame().id[0], 2u);
    Simulation rest(c.scene, middle, {GetParam(), "brute", 1});
    rest.run(1100);
    EXPECT_EQ(rest.state_hash(), whole.state_hash());
    whole.check_health();
}

INSTANTIATE_TEST_SUITE_P(Devices, OnTerrain, all_devices, device_name);

TEST_F(Folder, WalledEdgesKeepEverything) {
    surfaces::write_esri_grid(folder / "level.asc", level(6, 0));
    Scene s = scene("after = \"level.asc\"\nedge = \"walled\"\n");
    ASSERT_EQ(s.planes.size(), 4u);
    EXPECT_EQ(s.planes[1].name, "terrain east");
    EXPECT_EQ(s.planes[1].point.x, 5);
    InitialState p;
    p.positions = {{2.5, 2.5, 0.1}, {2.5, 2.0, 0.1}};
    p.radii = {0.1, 0.1};
    p.velocities = {{7, 1, 0}, {-6, -7, 0}};
    p.angular_velocities = {{}, {}};
    p.materials = {0, 0};
    Simulation simulation(s, p);
    simulation.run(3000);
    EXPECT_EQ(simulation.size(), 2u);
    EXPECT_TRUE(simulation.lost().empty());
}

TEST_F(Folder, ReleaseFillsBetweenBeforeAndAfter) {
    ElevationGrid after = level(21, 0), before = after;
    for (int j = 5; j <= 15; ++j)
        for (int i = 5; i <= 15; ++i) before.heights[static_cast<std::size_t>(21 * j + i)] = 4;
    for (std::size_t k = 0; k < after.heights.size(); ++k) {
        const double tilt = 0.5 * static_cast<double>(k % 21);
        after.heights[k] += tilt;
        before.heights[k] += tilt;
    }
    surfaces::write_esri_grid(folder / "after.asc", after);
    surfaces::write_esri_grid(folder / "before.asc", before);
    double volume = 0;
    for (double y = 0.005; y < 20; y += 0.01)
        for (double x = 0.005; x < 20; x += 0.01) volume += (before.height(x, y) - after.height(x, y)) * 1e-4;
    const std::string files = "after = \"after.asc\"\nbefore = \"before.asc\"\n[particles.slide]\ntype = \"release\"\nmaterial = \"rock\"\n";
    const InitialState spaced = place_particles(scene(files + "spacing = 0.4\n"));
    EXPECT_NEAR(static_cast<double>(spaced.size()), volume / 0.064, 0.02 * volume / 0.064);
    for (std::size_t i = 0; i < spaced.size(); ++i) {
        const Vec3d x = spaced.positions[i];
        ASSERT_EQ(spaced.radii[i], 0.2);
        ASSERT_GE((x.z - after.height(x.x, x.y)) / after.steepness(x.x, x.y), 0.2 - 1e-9);
        ASSERT_LE(x.z, before.height(x.x, x.y) + 0.2);
        for (std::size_t j = 0; j < i; ++j) ASSERT_GE(length(x - spaced.positions[j]), 0.4 - 1e-9);
    }
    const InitialState counted = place_particles(scene(files + "count = 3000\njitter = 0.05\n"));
    EXPECT_NEAR(static_cast<double>(counted.size()), 3000, 60);
    const InitialState again = place_particles(scene(files + "count = 3000\njitter = 0.05\n"));
    EXPECT_EQ(again.positions[77], counted.positions[77]);
}

TEST_F(Folder, ReleaseStandsClearOfRuggedGround) {
    Dice dice(9);
    ElevationGrid after = level(21, 0), before = after;
    for (std::size_t k = 0; k < after.heights.size(); ++k) before.heights[k] = 3 + (after.heights[k] = dice(0, 2));
    surfaces::write_esri_grid(folder / "after.asc", after);
    surfaces::write_esri_grid(folder / "before.asc", before);
    const InitialState s = place_particles(scene("after = \"after.asc\"\nbefore = \"before.asc\"\n[particles.slide]\ntype = \"release\"\nmaterial = \"rock\"\n"
                                                 "count = 3000\njitter = 0.03\n"));
    const ElevationGrid ground = surfaces::read_grid_file(folder / "after.asc", "");
    const double r = s.radii[0];
    double deepest = 0;
    for (const Vec3d& x : s.positions)
        for (double dy = -r; dy < r; dy += r / 12)
            for (double dx = -r; dx < r; dx += r / 12) {
                const double rest = r * r - dx * dx - dy * dy, z = ground.height(x.x + dx, x.y + dy);
                if (rest > 0 && !std::isnan(z)) deepest = std::max(deepest, z + std::sqrt(rest) - x.z);
            }
    EXPECT_EQ(deepest, 0);
}

TEST_F(Folder, ReleaseInsideAnOutline) {
    surfaces::write_esri_grid(folder / "after.asc", level(21, 5));
    write("outline.csv", "x,y\n2,2\n12,2\n12,7\n2,7\n");
    write("outline.geojson", R"({"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {}, "geometry": {"type": "Polygon",
        "coordinates": [[[2, 2], [12, 2], [12, 7], [2, 7], [2, 2]], [[4, 3], [6, 3], [6, 5], [4, 5], [4, 3]]]}}]})");
    const std::string layer = "after = \"after.asc\"\n[particles.slide]\ntype = \"release\"\nmaterial = \"rock\"\nspacing = 0.5\nthickness = 1\n";
    const InitialState square = place_particles(scene(layer + "polygon = \"outline.csv\"\n")), holed = place_particles(scene(layer + "polygon = \"outline.geojson\"\n"));
    EXPECT_EQ(square.size(), 20u * 10 * 2);
    EXPECT_EQ(holed.size(), square.size() - 4 * 4 * 2);
    for (const Vec3d& x : holed.positions) ASSERT_TRUE(x.x > 2 && x.x < 12 && x.y > 2 && x.y < 7 && x.z >= 5.25 && x.z < 6);
}

}  // namespace
}  // namespace grainray::test
