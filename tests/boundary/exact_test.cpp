// Meshes and terrain keep the promises of the rest: one trajectory whatever the lists, threads, device and place; exact
// restarts; loads that balance.
#include "devices.hpp"
#include "meshes.hpp"

namespace grainray::test {
namespace {

/// Hills on a lattice of 1/16 m, heights multiples of 2^-10 m: doubles hold them exactly after any shift of the tests.
ElevationGrid hills(std::int64_t columns, std::int64_t rows, const Vec3d& at = {}) {
    ElevationGrid g{columns, rows, at.x, at.y, 0.25, 0.25, {}};
    for (std::int64_t j = 0; j < rows; ++j)
        for (std::int64_t i = 0; i < columns; ++i)
            g.heights.push_back(at.z + std::round(1024 * (0.3 * std::sin(0.7 * i) * std::cos(0.5 * j) + 0.05 * i)) / 1024);
    return g;
}

void add_terrain(Case& c, ElevationGrid g) {
    c.scene.terrain.emplace();
    c.scene.terrain->material = "wall";
    c.scene.terrain->after = std::move(g);
}

/// Grains in a tub on hills, with a paddle that turns.
Case busy(const Vec3d& at = {}) {
    Case c = column(7, 6, 8);
    c.scene.planes.clear();
    for (Vec3d& p : c.initial.positions)
        for (int a = 0; a < 3; ++a) p[a] = std::round((p[a] + (a == 2 ? 0.9 : 0.6)) * 0x1p30) * 0x1p-30 + at[a];
    c.scene.materials[1].normal_stiffness = 1e6;
    c.scene.materials[1].tangential_stiffness = 2e5;
    add_terrain(c, hills(14, 13, at));
    add_mesh(c, box({-0.25, -0.25, -1}, {2.75, 2.5, 3}, 3), "tub");
    c.scene.meshes[0].translation = at;
    add_mesh(c, square(0.5, 5), "paddle");
    Mesh& paddle = c.scene.meshes[1];
    paddle.rotation = {1.5707963267948966, 0, 0};
    paddle.translation = at + Vec3d{1.5, 1.25, 0.75};
    paddle.motion.rotation_axis = {0, 0, 1};
    paddle.motion.rotation_point = at + Vec3d{1, 1, 0};
    paddle.motion.rotation_rate = 2;
    paddle.motion.oscillation_amplitude = {0, 0, 0.1};
    paddle.motion.oscillation_frequency = 3;
    return c;
}

class ExactFacets : public ::testing::TestWithParam<Device> {
protected:
    void SetUp() override { GRAINRAY_NEEDS(GetParam()); }
};

TEST_P(ExactFacets, WhateverTheListsAndTheBackend) {
    Case c = busy();
    const auto expected = hash_after(c, 300, GetParam());
    EXPECT_EQ(hash_after(c, 300, GetParam(), "brute"), expected);
    for (const double interval : {1.0, 3.0, 60.0}) {
        c.scene.search.interval = interval;
        EXPECT_EQ(hash_after(c, 300, GetParam()), expected) << interval;
    }
}

TEST_P(ExactFacets, TheSameOnTheCpu) { EXPECT_EQ(hash_after(busy(), 300, GetParam()), hash_after(busy(), 300, Device::cpu, "cells", 1)); }

TEST_P(ExactFacets, Restart) {
    const Case c = busy();
    Simulation whole = c.start(GetParam());
    whole.run(170);
    const Checkpoint middle = whole.checkpoint();
    EXPECT_GT(middle.facet.size(), 10u);
    Simulation rest(c.scene, middle, {GetParam(), "brute", 1});
    EXPECT_EQ(rest.state_hash(), middle.state_hash);
    whole.run(170);
    rest.run(170);
    EXPECT_EQ(rest.state_hash(), whole.state_hash());
}

TEST_P(ExactFacets, TheSameMotionAnywhere) {
    const Vec3d shift{1e4, 2e5, 3e3};
    Simulation here = busy().start(GetParam()), there = busy(shift).start(GetParam());
    here.run(300);
    there.run(300);
    const Frame a = here.frame(), b = there.frame();
    for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(a.velocity[i], b.velocity[i]) << i;
        ASSERT_EQ(a.angular_velocity[i], b.angular_velocity[i]) << i;
        for (int k = 0; k < 3; ++k) ASSERT_NEAR(a.position[i][k] + shift[k], b.position[i][k], 1e-10);
    }
}

/// What the boundaries push is what the grains weigh, once they lie still.
TEST_P(ExactFacets, LoadsCarryTheWeight) {
    Case c = busy();
    c.scene.meshes.pop_back();
    c.scene.contact.mass_damping = 0.5;
    Simulation s = c.start(GetParam());
    s.run(6000);
    const Statistics now = s.statistics();
    ASSERT_EQ(now.surfaces.size(), 2u);
    const Vec3d sum = now.surfaces[0].force + now.surfaces[1].force;
    double weight = 0;
    for (const float m : s.frame().mass) weight += 10.0 * m;
    EXPECT_EQ(now.surfaces[0].name, "tub");
    EXPECT_GT(now.surfaces[1].contacts, 10u);
    EXPECT_NEAR(sum.z, -weight, 0.05 * weight);
    EXPECT_NEAR(sum.x, 0, 0.05 * weight);
    EXPECT_NEAR(sum.y, 0, 0.05 * weight);
}

TEST_P(ExactFacets, TorqueAboutThePointOfTheMotion) {
    Case c = empty_case();
    c.add({0.7, 0, 0.1 - 8.37758e-6}, 0.1);
    add_mesh(c, square(1, 1));
    c.scene.meshes[0].motion.rotation_point = {0.2, 0, 0};
    const SurfaceLoad load = c.start(GetParam()).statistics().surfaces.at(0);
    EXPECT_NEAR(load.force.z, -83.7758, 0.1);
    EXPECT_NEAR(load.torque.y, 0.5 * 83.7758, 0.1);  // (0.5, 0, 0) x (0, 0, -F)
}

INSTANTIATE_TEST_SUITE_P(Devices, ExactFacets, all_devices, device_name);

TEST(ExactFacetsOnThreads, OneTwoThree) {
    const auto one = hash_after(busy(), 250, Device::cpu, "cells", 1);
    EXPECT_EQ(hash_after(busy(), 250, Device::cpu, "cells", 2), one);
    EXPECT_EQ(hash_after(busy(), 250, Device::cpu, "cells", 3), one);
}

}  // namespace
}  // namespace grainray::test
