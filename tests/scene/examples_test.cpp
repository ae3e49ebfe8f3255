// Every file of examples/ loads, and the published numbers are in them.
#include <algorithm>
#include <filesystem>
#include <fstream>

#include "folders.hpp"
#include "scene_text.hpp"

namespace grainray::test {
namespace {

const std::filesystem::path folder = project_folder() / "examples";

std::vector<std::string> example_names() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

Scene example(const std::string& name, std::vector<std::string> overrides = {}) {
    if (name == "debris_flow") {  // its terrain is made by a command, not kept
        const auto flat = std::filesystem::temp_directory_path() / "grainray_example_flat.asc", bump = std::filesystem::temp_directory_path() / "grainray_example_bump.asc";
        const std::string head = "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 50\n";
        std::ofstream(flat) << head << "1 1 1 1 1 1 1 1 1\n";
        std::ofstream(bump) << head << "1 1 1 1 9 1 1 1 1\n";
        overrides.push_back("terrain.after=" + flat.string());
        overrides.push_back("terrain.before=" + bump.string());
    }
    return load_scene(folder / (name + ".toml"), overrides);
}

class Examples : public testing::TestWithParam<std::string> {};

TEST_P(Examples, LoadAndPlaceParticlesOnTheRightSideOfEveryPlane) {
    const Scene scene = example(GetParam());
    EXPECT_FALSE(scene.title.empty());
    const InitialState s = place_particles(scene);
    EXPECT_TRUE(s.size() > 0 || !scene.streams.empty());
    for (const Plane& plane : scene.planes)
        for (std::size_t i = 0; i < s.size(); ++i)
            ASSERT_GE(dot(plane.normal, s.positions[i] - plane.point), s.radii[i] * (1 - 1e-9))
                << plane.name << ", particle " << i;
}

INSTANTIATE_TEST_SUITE_P(All, Examples, testing::ValuesIn(example_names()),
                         [](const auto& example) { return example.param; });

TEST(ColumnExample, StableReading) {
    const Scene s = example("column_collapse");
    EXPECT_EQ(s.dt, 1e-3);
    EXPECT_EQ(s.gravity, (Vec3d{0, 0, -10}));
    EXPECT_EQ(s.contact.mass_damping, 0.1);
    EXPECT_EQ(place_particles(s).size(), 20160u);
    const MaterialPair grains = contact_parameters(s, 0, 0, false), wall = contact_parameters(s, 0, 1, true);
    EXPECT_EQ(grains.normal_stiffness, 1e5);
    EXPECT_EQ(grains.tangential_damping, 0);
    EXPECT_EQ(wall.normal_stiffness, 1e7);
    EXPECT_NEAR(wall.tangential_stiffness, 2e7 / 7, 1);
    EXPECT_EQ(wall.friction, 1.0);
    EXPECT_EQ(wall.tangential_damping, 0);
}

TEST(ColumnExample, SeriesReading) {
    const Scene s = example("column_collapse_series");
    EXPECT_NEAR(contact_parameters(s, 0, 1, true).normal_stiffness, 1.98e5, 20);
    EXPECT_EQ(contact_parameters(s, 0, 1, true).friction, 0.5);
    EXPECT_EQ(s.dt, 1e-3);
}

TEST(ColumnExample, LiteralReading) {
    const Scene s = example("column_collapse_literal");
    EXPECT_EQ(s.dt, 2e-4);
    EXPECT_EQ(contact_parameters(s, 0, 1, true).tangential_stiffness, 1e7);
    EXPECT_EQ(contact_parameters(s, 0, 1, true).tangential_damping, 0.5);
    EXPECT_EQ(contact_parameters(s, 0, 0, false).tangential_damping, 0.5);
}

TEST(ColumnExample, PublishedSizeByOverrides) {
    const Scene s = example("packing", {"particles.column.count=[71,80,141]", "planes.side_far.point=[0,19.2,0]",
                                        "planes.front.point=[17.04,0,0]"});
    const InitialState p = place_particles(s);
    EXPECT_EQ(p.size(), 800880u);
    for (const Vec3d& x : p.positions) ASSERT_TRUE(x.x + 0.1 < 17.04 && x.y + 0.1 < 19.2);
}

}  // namespace
}  // namespace grainray::test
