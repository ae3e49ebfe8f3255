// One trajectory, to the last bit: any back end, number of threads, list settings, device, and from run to run.
#include "devices.hpp"
#include "grainray/neighbors.hpp"
#include "scenes.hpp"

namespace grainray::test {
namespace {

class SameHash : public ::testing::TestWithParam<Device> {
protected:
    void SetUp() override { GRAINRAY_NEEDS(GetParam()); }
};

// What every machine, compiler and device must find. A change of physics changes them, and says so in its commit.
constexpr std::uint64_t golden_column = 0x87b590cca8a7af4, golden_polydisperse = 0x9e1149a9c3db129a, golden_periodic = 0x39b862e419b4c6b5;

TEST_P(SameHash, Golden) {
    EXPECT_EQ(hash_after(column(12, 10, 20), 400, GetParam()), golden_column);
    EXPECT_EQ(hash_after(column(10, 10, 12, 4), 300, GetParam()), golden_polydisperse);
    EXPECT_EQ(hash_after(periodic_column(10, 8, 16), 400, GetParam()), golden_periodic);
}

TEST_P(SameHash, WhateverTheBackend) {
    const Case c = column(9, 7, 12, 3);
    const auto cells = hash_after(c, 250, GetParam(), "cells");
    EXPECT_EQ(hash_after(c, 250, GetParam(), "auto"), cells);
    for (const BackendInfo& b : search_backends(GetParam()))
        if (b.available) {
            EXPECT_EQ(hash_after(c, 250, GetParam(), b.name), cells) << b.name;
        }
    const Case measured = column(20, 18, 20);  // so many that auto measures
    EXPECT_EQ(hash_after(measured, 60, GetParam(), "auto"), hash_after(measured, 60, GetParam(), "cells"));
}

TEST_P(SameHash, TheVariantOfTheSceneIsTaken) {
    Case c = column(6, 5, 6);
    c.scene.search.backend = "rays";
    c.scene.search.rays.variant = "published";
    for (const BackendInfo& b : search_backends(GetParam()))
        if (b.name == "rays" && !b.available) GTEST_SKIP() << b.reason;
    EXPECT_EQ(c.start(GetParam(), "auto").search().backend, "rays-published");
    EXPECT_EQ(hash_after(c, 100, GetParam(), "auto"), hash_after(c, 100, GetParam(), "cells"));
}

TEST_P(SameHash, WhateverTheMarginsAndTheInterval) {
    Case c = column(12, 10, 14);
    const auto expected = hash_after(c, 300, GetParam());
    for (const double skin : {0.005, 0.3})
        for (const double interval : {1.0, 4.0, 100.0}) {
            c.scene.search.skin = skin;
            c.scene.search.interval = interval;
            EXPECT_EQ(hash_after(c, 300, GetParam()), expected) << skin << " " << interval;
        }
}

TEST_P(SameHash, RunAfterRunAndCallAfterCall) {
    const Case c = periodic_column(10, 8, 12);
    Simulation a = c.start(GetParam()), b = c.start(GetParam());
    a.run(200);
    for (int k = 0; k < 200; ++k) {
        b.step();
        if (k % 50 == 0) b.statistics();  // looking changes nothing
    }
    EXPECT_EQ(a.state_hash(), b.state_hash());
}

INSTANTIATE_TEST_SUITE_P(Devices, SameHash, all_devices, device_name);

TEST(SameHashOnThreads, OneTwoThree) {
    const Case c = column(14, 12, 20);  // several blocks where there are several threads
    const auto one = hash_after(c, 300, Device::cpu, "cells", 1);
    EXPECT_EQ(hash_after(c, 300, Device::cpu, "cells", 2), one);
    EXPECT_EQ(hash_after(c, 300, Device::cpu, "cells", 3), one);
}

TEST(StateHash, SeesEverySmallestChange) {
    Case c = column(4, 4, 4);
    const auto base = c.start().state_hash();
    Case moved = c;
    moved.initial.positions[5].x += 1e-11;
    EXPECT_NE(moved.start().state_hash(), base);
    Case faster = c;
    faster.initial.velocities[5].y = std::nextafter(static_cast<float>(faster.initial.velocities[5].y), 1e9f);
    EXPECT_NE(faster.start().state_hash(), base);
    Case spun = c;
    spun.initial.angular_velocities[63].z = 1e-30;
    EXPECT_NE(spun.start().state_hash(), base);
}

TEST(Translation, TheSameMotionAnywhere) {
    Case here = column(6, 5, 8), there = here;
    const Vec3d shift{16384, 262144, 4096};  // powers of two: the doubles themselves keep every digit that is used here
    const auto shorten = [](Vec3d& p) {
        for (int a = 0; a < 3; ++a) p[a] = std::round(p[a] * 0x1p30) * 0x1p-30;
    };
    for (auto* c : {&here, &there}) {
        for (auto& p : c->initial.positions) shorten(p);
        for (auto& p : c->scene.planes) shorten(p.point);
    }
    for (auto& p : there.initial.positions) p += shift;
    for (auto& p : there.scene.planes) p.point += shift;
    Simulation a = here.start(), b = there.start();
    a.run(300);
    b.run(300);
    const Frame fa = a.frame(), fb = b.frame();
    for (std::size_t i = 0; i < fa.size(); ++i) {
        ASSERT_EQ(fa.velocity[i], fb.velocity[i]) << i;
        ASSERT_EQ(fa.angular_velocity[i], fb.angular_velocity[i]) << i;
        for (int k = 0; k < 3; ++k) ASSERT_NEAR(fa.position[i][k] + shift[k], fb.position[i][k], 1e-10);
    }
}

}  // namespace
}  // namespace grainray::test
