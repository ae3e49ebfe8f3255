// 2N steps equal N, checkpoint, restart, N: bit for bit, on any device, histories and moving planes included.
#include "devices.hpp"
#include "scenes.hpp"

namespace grainray::test {
namespace {

Case moving_walls() {
    Case c = column(9, 8, 12);
    c.scene.planes[0].motion.oscillation_amplitude = {0, 0, 0.05};
    c.scene.planes[0].motion.oscillation_frequency = 4;
    c.scene.planes[1].motion.velocity = {0.4, 0, 0};
    c.scene.planes[2].motion.rotation_axis = {0, 0, 1};
    c.scene.planes[2].motion.rotation_rate = 0.3;
    c.scene.planes[2].motion.stop = 0.15;
    return c;
}

class Restart : public ::testing::TestWithParam<Device> {
protected:
    void SetUp() override { GRAINRAY_NEEDS(GetParam()); }

    void expect_exact(const Case& c, std::uint64_t half) {
        Simulation whole = c.start(GetParam());
        whole.run(half);
        const Checkpoint middle = whole.checkpoint();
        EXPECT_EQ(middle.state_hash, whole.state_hash());
        whole.run(half);
        Simulation rest(c.scene, middle, {GetParam(), "brute", 1});
        EXPECT_EQ(rest.state_hash(), middle.state_hash) << "before any step";
        rest.run(half);
        EXPECT_EQ(rest.state_hash(), whole.state_hash());
        EXPECT_EQ(rest.step_count(), 2 * half);
    }
};

TEST_P(Restart, Column) { expect_exact(column(10, 9, 14), 180); }
TEST_P(Restart, Polydisperse) { expect_exact(column(8, 8, 10, 4), 150); }
TEST_P(Restart, Periodic) { expect_exact(periodic_column(9, 8, 12), 180); }
TEST_P(Restart, MovingWalls) { expect_exact(moving_walls(), 120); }

TEST_P(Restart, ContactsKeepTheirFriction) {
    Simulation s = column(9, 8, 12).start(GetParam());
    s.run(250);
    const Checkpoint c = s.checkpoint();
    EXPECT_GT(c.contact_a.size(), 100u);
    EXPECT_GT(c.wall_particle.size(), 10u);
    for (std::size_t k = 0; k < c.contact_a.size(); ++k) EXPECT_GT(c.contact_a[k], c.contact_b[k]);
}

INSTANTIATE_TEST_SUITE_P(Devices, Restart, all_devices, device_name);

TEST(RestartAcrossDevices, GpuGoesOnWhereTheCpuStopped) {
    GRAINRAY_NEEDS(Device::cuda);
    const Case c = moving_walls();
    Simulation cpu = c.start(Device::cpu);
    cpu.run(100);
    Simulation gpu(c.scene, cpu.checkpoint(), {Device::cuda, "cells", 0});
    cpu.run(100);
    gpu.run(100);
    EXPECT_EQ(gpu.state_hash(), cpu.state_hash());
    Simulation back(c.scene, gpu.checkpoint(), {Device::cpu, "cells", 0});
    gpu.run(50);
    back.run(50);
    EXPECT_EQ(gpu.state_hash(), back.state_hash());
}

TEST(Restart, NoParticlesAndOneParticle) {
    Case none = empty_case();
    Simulation n = none.start();
    n.run(10);
    EXPECT_EQ(n.step_count(), 10u);
    EXPECT_EQ(n.frame().size(), 0u);
    EXPECT_EQ(Simulation(none.scene, n.checkpoint()).state_hash(), n.state_hash());

    Case one = empty_case();
    one.add({1, 2, 3}, 0.1, {0, 0, 1});
    Simulation s = one.start();
    s.run(10);
    Simulation t(one.scene, s.checkpoint());
    s.run(10);
    t.run(10);
    EXPECT_EQ(s.state_hash(), t.state_hash());
}

}  // namespace
}  // namespace grainray::test
