// Streams: how many come, where, and that the same come whatever interrupts or computes the run.
#include "boundary/meshes.hpp"
#include "grainray/neighbors.hpp"
#include "streams.hpp"

namespace grainray::test {
namespace {

class Streams : public ::testing::TestWithParam<Device> {
protected:
    void SetUp() override { GRAINRAY_NEEDS(GetParam()); }
};

TEST_P(Streams, TheRateIsObeyed) {
    Case c = empty_case();
    ParticleStream s = box_stream("s", {{0, 0, 0}, {2, 2, 1}}, 250, 0.05);
    s.interval = 0.04;
    s.start = 0.1;
    s.stop = 0.53;
    c.scene.streams.push_back(s);
    Simulation simulation = c.start(GetParam());
    EXPECT_EQ(simulation.size(), 0u);
    for (int step = 10; step <= 1000; step += 10) {
        simulation.run(10);
        const double time = std::floor((step - 100) / 40.0 + 1e-9) * 0.04;  // whole intervals
        const double due = step >= 530 ? 107 : step < 100 ? 0 : std::floor(250 * time + 1e-6);  // 250 * 0.43 = 107.5
        ASSERT_EQ(simulation.streams()[0].inserted, due) << step;
        ASSERT_EQ(simulation.size(), due);
    }
}

TEST_P(Streams, AMassRateAndATotalMass) {
    Case c = empty_case();
    ParticleStream s = box_stream("s", {{0, 0, 0}, {2, 2, 1}}, 0);
    s.size = {SizeLaw::lognormal, 0, 0.03, 0.12, 0.06, 0.02, {}, {}};
    s.rate = {0, 500};
    s.total.mass = 200;
    s.interval = 0.01;
    c.scene.streams.push_back(s);
    const double most = 4.0 / 3.0 * 3.14159265 * std::pow(0.12, 3) * 2000;
    Simulation simulation = c.start(GetParam());
    for (int k = 1; k <= 60; ++k) {
        simulation.run(10);
        const double due = std::min(500 * 0.01 * k, 200.0), mass = simulation.streams()[0].mass;
        ASSERT_LE(mass, due * (1 + 1e-6)) << k;
        ASSERT_GE(mass + simulation.streams()[0].waiting_mass, due - most) << k;
        ASSERT_NEAR(mass, total_mass(simulation.frame()), 1e-9 * mass + 1e-12);
    }
}

TEST_P(Streams, ATotalNumberEndsIt) {
    Case c = empty_case();
    c.scene.streams.push_back(box_stream("s", {{0, 0, 0}, {2, 2, 1}}, 250, 0.05));
    c.scene.streams[0].total.particles = 77;
    Simulation simulation = c.start(GetParam());
    simulation.run(1000);
    EXPECT_EQ(simulation.streams()[0].inserted, 77u);
    EXPECT_EQ(simulation.streams()[0].waiting, 0u);
}

TEST_P(Streams, NothingOverlapsWhenItAppearsAndAllIsInTheBox) {
    Case c = fountain();
    c.scene.streams[0].rate.particles = 2500;
    c.scene.streams[0].interval = 0.02;
    for (int k = 0; k < 40; ++k) c.add({0.15 + 0.2 * (k % 4), 0.15 + 0.2 * (k / 4 % 4), 1.3 + 0.25 * (k / 16)}, 0.08);  // in the inlet
    const Box box = std::get<Box>(c.scene.streams[0].inlet);
    Simulation simulation = c.start(GetParam());
    auto next = static_cast<std::uint32_t>(c.initial.size());
    for (int k = 0; k < 1500; ++k) {
        simulation.run(1);
        const Frame f = simulation.frame();
        if (f.size() == 0 || f.id.back() < next) continue;
        const auto first = static_cast<std::size_t>(std::lower_bound(f.id.begin(), f.id.end(), next) - f.id.begin());
        ASSERT_GE(smallest_gap(f, first), 0) << k;
        for (std::size_t i = first; i < f.size(); ++i)
            for (int a = 0; a < 3; ++a) {
                ASSERT_GE(f.position[i][a] - f.radius[i], box.lower[a] - 1e-6);
                ASSERT_LE(f.position[i][a] + f.radius[i], box.upper[a] + 1e-6);
                ASSERT_NEAR(f.velocity[i][a], c.scene.streams[0].velocity[a], c.scene.streams[0].velocity_spread[a]);
            }
        next = f.id.back() + 1;
    }
    EXPECT_GT(next, 150u);
    EXPECT_GT(simulation.streams()[0].waiting, 0u);  // more than finds room: some were carried over
}

TEST_P(Streams, WhatWaitsComesOnceThereIsRoom) {
    Case c = empty_case();
    c.scene.gravity = {};
    ParticleStream s = box_stream("s", {{0, 0, 0}, {1, 1, 1}}, 1000, 0.15);
    s.velocity = {0, 0, -0.1};
    s.interval = 0.01;
    s.stop = 0.1;
    c.scene.streams.push_back(s);
    c.scene.removals.push_back(half_space("below", {0, 0, 0}, {0, 0, -1}, 1));
    Simulation simulation = c.start(GetParam());
    simulation.run(100);
    const StreamReport first = simulation.streams()[0];
    EXPECT_LT(first.inserted, 60u);  // 0.4 of the box is full
    EXPECT_EQ(first.inserted + first.waiting, 100u);
    simulation.run(30000);
    EXPECT_EQ(simulation.streams()[0].inserted, 100u);
    EXPECT_EQ(simulation.streams()[0].waiting, 0u);
    EXPECT_EQ(simulation.size() + simulation.removals()[0].particles, 100u);
}

TEST_P(Streams, ARestartGoesOnToTheBit) {
    Case c = fountain();
    c.scene.streams[0].rate.particles = 1500;  // some wait all the time
    c.scene.streams.push_back(box_stream("second", {{0.2, 0.2, 0.9}, {0.8, 0.8, 1.15}}, 60, 0.07));
    Simulation whole = c.start(GetParam());
    whole.run(2503);
    const Checkpoint middle = whole.checkpoint();
    ASSERT_FALSE(middle.waiting_number.empty());
    ASSERT_GT(whole.removals()[0].particles, 0u);
    whole.run(997);
    for (const char* backend : {"cells", "brute"}) {
        Simulation rest(c.scene, middle, {GetParam(), backend, 1});
        EXPECT_EQ(rest.state_hash(), middle.state_hash);
        rest.run(500);
        rest.run(497);
        EXPECT_EQ(rest.state_hash(), whole.state_hash()) << backend;
        EXPECT_EQ(rest.frame().id, whole.frame().id);
        for (std::size_t k = 0; k < 2; ++k) {
            EXPECT_EQ(rest.streams()[k].inserted, whole.streams()[k].inserted);
            EXPECT_EQ(rest.streams()[k].waiting, whole.streams()[k].waiting);
            EXPECT_EQ(rest.streams()[k].mass, whole.streams()[k].mass);
        }
        EXPECT_EQ(rest.removals()[0].particles, whole.removals()[0].particles);
    }
    whole.check_health();
}

// What every machine, compiler and device must find.
constexpr std::uint64_t golden_fountain = 0x413be526be3c50c6;

TEST_P(Streams, TheSameOnEveryDeviceAndBackend) {
    const Case c = fountain();
    EXPECT_EQ(hash_after(c, 2000, Device::cpu, "brute", 1), golden_fountain);
    for (const BackendInfo& b : search_backends(GetParam()))
        if (b.available) {
            EXPECT_EQ(hash_after(c, 2000, GetParam(), b.name), golden_fountain) << b.name;
        }
}

TEST_P(Streams, TheBalanceIsKept) {
    const Case c = fountain();
    Simulation simulation = c.start(GetParam());
    const double first_mass = total_mass(simulation.frame());
    std::map<std::uint32_t, int> seen;
    for (int k = 0; k < 20; ++k) {
        simulation.run(150);
        const StreamReport in = simulation.streams()[0];
        const RemovalReport out = simulation.removals()[0];
        const Frame f = simulation.frame();
        ASSERT_EQ(f.size() + out.particles, c.initial.size() + in.inserted);
        ASSERT_NEAR(total_mass(f), first_mass + in.mass - out.mass, 1e-9 * (first_mass + in.mass));
        ASSERT_EQ(simulation.lost().size(), out.particles);
    }
    for (const LostParticle& p : simulation.lost()) ++seen[p.id];
    for (const std::uint32_t id : simulation.frame().id) ++seen[id];
    EXPECT_EQ(seen.size(), c.initial.size() + simulation.streams()[0].inserted);  // no id twice
    EXPECT_EQ(seen.rbegin()->first, seen.size() - 1);
    EXPECT_GT(simulation.removals()[0].particles, 30u);
}

TEST_P(Streams, WhatTheyDoNotTouchMovesAsWithoutThem) {
    Case quiet = column(8, 6, 8);
    quiet.scene.planes.erase(quiet.scene.planes.begin());
    add_mesh(quiet, square(6, 5), "floor");
    Case busy = quiet;
    busy.scene.streams.push_back(box_stream("far", {{0, 0, 50}, {2, 2, 51}}, 100));
    busy.scene.streams[0].velocity = {0, 0, 1};
    busy.scene.streams[0].interval = 0.013;
    busy.scene.removals.push_back(half_space("high", {0, 0, 50.5}, {0, 0, 1}, 7));
    Simulation a = quiet.start(GetParam()), b = busy.start(GetParam());
    a.run(400);
    b.run(400);
    EXPECT_GT(b.removals()[0].particles, 3u);
    const Frame fa = a.frame(), fb = b.frame();
    ASSERT_GT(fb.size(), fa.size());
    const Checkpoint ca = a.checkpoint(), cb = b.checkpoint();
    for (std::size_t i = 0; i < fa.size(); ++i) {
        ASSERT_EQ(fa.id[i], fb.id[i]);
        ASSERT_EQ(ca.velocity[i], cb.velocity[i]) << i;
        ASSERT_EQ(ca.angular_velocity[i], cb.angular_velocity[i]) << i;
        ASSERT_LT(length(fa.position[i] - fb.position[i]), 1e-9) << i;
    }
    EXPECT_GT(ca.contact_history.size(), 300u);
    EXPECT_EQ(ca.contact_history, cb.contact_history);
    EXPECT_GT(ca.wall_history.size(), 10u);
    EXPECT_EQ(ca.wall_history, cb.wall_history);
    EXPECT_GT(ca.facet_history.size(), 20u);
    EXPECT_EQ(ca.facet, cb.facet);
    EXPECT_EQ(ca.facet_history, cb.facet_history);
}

TEST_P(Streams, FromNothingToNothingAndOn) {
    Case c = empty_case();
    ParticleStream s = box_stream("s", {{0, 0, 1}, {1, 1, 2}}, 50);
    s.stop = 0.3;
    c.scene.streams.push_back(s);
    s.name = "later";
    s.start = 1.5;
    s.stop = 1.8;
    c.scene.streams.push_back(s);
    c.scene.removals.push_back(half_space("below", {0, 0, 0}, {0, 0, -1}, 10));
    Simulation simulation = c.start(GetParam());
    simulation.run(1400);
    EXPECT_EQ(simulation.size(), 0u);
    EXPECT_EQ(simulation.streams()[0].inserted, 15u);
    const Checkpoint empty = simulation.checkpoint();
    EXPECT_EQ(empty.next_id, 15u);
    simulation.run(600);
    EXPECT_EQ(simulation.streams()[1].inserted, 15u);
    EXPECT_GT(simulation.size(), 0u);
    EXPECT_EQ(simulation.frame().id.back(), 29u);
    Simulation again(c.scene, empty, {GetParam(), "auto", 0});
    again.run(600);
    EXPECT_EQ(again.state_hash(), simulation.state_hash());
}

TEST_P(Streams, AStreamAddedAtARestartBeginsThere) {
    Case c = column(4, 4, 4);
    Simulation before = c.start(GetParam());
    before.run(200);
    Case more = c;
    more.scene.streams.push_back(box_stream("s", {{0, 0, 3}, {0.8, 0.8, 4}}, 100));
    more.scene.streams[0].interval = 0.05;
    Simulation after(more.scene, before.checkpoint(), {GetParam(), "auto", 0});
    after.run(100);
    EXPECT_EQ(after.streams()[0].inserted, 10u);
    ParticleStream& s = more.scene.streams[0];
    s.size.radius = 0.3;
    EXPECT_THROW(Simulation(more.scene, before.checkpoint(), {GetParam(), "auto", 0}), InputError);
}

TEST_P(Streams, PeriodicInletsReachAcross) {
    Case c = empty_case();
    c.scene.gravity = {};
    c.scene.domain.box = Box{{-5, 0, -40}, {5, 2, 4}};
    c.scene.domain.periodic = {false, true, false};
    ParticleStream across = box_stream("across", {{-1, 0, 0}, {1, 2, 1}}, 150), beside = box_stream("beside", {{-1, 0.05, 1.5}, {1, 1.9, 2.5}}, 150);
    c.scene.streams = {across, beside};
    Simulation simulation = c.start(GetParam());
    bool over_the_edge = false;
    for (int k = 0; k < 700; ++k) {
        simulation.run(1);
        ASSERT_EQ(simulation.statistics().max_overlap_ratio, 0) << k;  // all go alike, so nothing ever meets
        for (const Vec3d& x : simulation.frame().position) over_the_edge = over_the_edge || x.y < 0.1 || x.y > 1.9;
    }
    EXPECT_GT(simulation.size(), 100u);
    EXPECT_TRUE(over_the_edge);
}

INSTANTIATE_TEST_SUITE_P(Devices, Streams, all_devices, device_name);

TEST(StreamsOnThreads, OneTwoThree) {
    Case c = column(14, 12, 18);  // several blocks where there are several threads
    c.scene.streams.push_back(box_stream("s", {{0, 0, 4.2}, {3, 2.6, 5}}, 2000));
    c.scene.streams[0].interval = 0.02;
    c.scene.removals.push_back(half_space("front", {3.2, 0, 0}, {1, 0, 0}, 30));
    const auto one = hash_after(c, 300, Device::cpu, "cells", 1);
    EXPECT_EQ(hash_after(c, 300, Device::cpu, "cells", 2), one);
    EXPECT_EQ(hash_after(c, 300, Device::cpu, "auto", 3), one);
}

}  // namespace
}  // namespace grainray::test
