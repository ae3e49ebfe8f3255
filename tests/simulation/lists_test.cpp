// A list may be old but never wrong: scenes made to outrun it are compared with runs that search at every step.
#include "devices.hpp"
#include "scenes.hpp"

namespace grainray::test {
namespace {

Case free_case() {
    Case c = empty_case();
    c.scene.gravity = {};
    c.scene.contact.mass_damping = 0;
    return c;
}

Case head_on() {
    Case c = free_case();
    c.add({0, 0, 0}, 0.1, {30, 0, 0});
    c.add({3, 0.05, 0}, 0.1, {-30, 0, 0});
    return c;
}
Case overtaking() {
    Case c = free_case();
    c.add({0, 0, 0}, 0.1, {40, 0, 0});
    c.add({1, 0.02, 0.01}, 0.1, {25, 0, 0});
    for (int i = 0; i < 30; ++i) c.add({0.5 + 0.21 * i, 0.5, 0}, 0.1);
    return c;
}
Case sheared_block() {
    Case c = free_case();
    for (int k = 0; k < 10; ++k)
        for (int j = 0; j < 6; ++j)
            for (int i = 0; i < 10; ++i) c.add({0.2 * i + 0.01 * (j % 3), 0.2 * j, 0.199 * k}, 0.1, {4.0 * k, 0, 0});
    return c;
}
Case turning_pile() {
    Case c = free_case();
    for (int k = 0; k < 4; ++k)
        for (int j = -8; j <= 8; ++j)
            for (int i = -8; i <= 8; ++i) c.add({0.21 * i, 0.21 * j, 0.21 * k}, 0.1, {-8 * 0.21 * j, 8 * 0.21 * i, 0}, {0, 0, 8});
    return c;
}
Case runaway_over_a_bed() {
    Case c = column(14, 6, 4);
    c.scene.contact.mass_damping = 0;
    for (auto& v : c.initial.velocities) v = {};
    c.add({0.3, 0.6, 1.2}, 0.1, {25, 0, -2});
    return c;
}
Case periodic_crossing() {
    Case c = free_case();
    c.scene.domain.box = Box{{0, 0, 0}, {2, 2, 2}};
    c.scene.domain.periodic = {true, true, true};
    c.add({0.05, 0.1, 0.1}, 0.1, {-20, 1, 0});
    c.add({1.5, 0.15, 1.95}, 0.1, {20, 0, 1});
    for (int i = 0; i < 40; ++i) c.add({0.25 * (i % 8) + 0.1, 0.4 + 0.3 * (i / 8), 1 + 0.02 * i}, 0.08, {3.0 * (i % 5), -7.0 * (i % 3), 9.0 * (i % 2)});
    return c;
}
/// Blocks that drive at each other with an empty box or two between, and before each a particle that runs ahead. Ten pairs of them, so that
/// boxes begin at ten places. Runaways have margins of nearly 3 radii then, on one side or on both.
Case runaways_between_blocks(double gap, double left, double right) {
    Case c = free_case();
    c.scene.search.interval = 150;
    c.scene.search.skin = 0.02;
    for (int pair = 0; pair < 10; ++pair) {
        const double x = 0.08 * pair, y = 3.2 * pair;
        for (int k = 0; k < 64; ++k) {
            const Vec3d place{0.205 * (k % 4), 0.205 * (k / 4 % 4), 0.205 * (k / 16)};
            c.add(place + Vec3d{x, y, 0}, 0.1, {2, 0, 0});
            c.add(place + Vec3d{x + 1.02 + gap, y, 0}, 0.1, {-2, 0, 0});
        }
        c.add({x + 0.82, y + 0.3, 0.3}, 0.1, {left, 0, 0});
        c.add({x + 0.82 + gap, y + 0.32, 0.3}, 0.1, {right, 0, 0});
    }
    return c;
}
Case runaway_against_a_block() { return runaways_between_blocks(0.87, 5.3, -3.65); }
Case two_runaways() { return runaways_between_blocks(0.95, 5.3, -5.3); }
Case runaways_three_boxes_apart() { return runaways_between_blocks(1.65, 5.3, -5.3); }
Case sizes_one_to_twenty() {
    Case c = column(5, 5, 3);
    for (int i = 0; i < 400; ++i) c.add({0.05 + 0.02 * (i % 40), 0.1 + 0.05 * (i / 40), 1.0 + 0.001 * i}, 0.005, {0.3 * (i % 7), 0, -5});
    c.scene.materials[0].normal_stiffness = c.scene.materials[0].tangential_stiffness = 2e3;
    c.scene.materials[1].normal_stiffness = 2e3;
    c.scene.materials[1].tangential_stiffness = 1e3;
    c.scene.dt = 2e-5;
    return c;
}

struct Adversary {
    const char* name;
    Case (*make)();
};
const Adversary adversaries[] = {{"head_on", head_on}, {"overtaking", overtaking}, {"sheared_block", sheared_block}, {"turning_pile", turning_pile},
                                 {"runaway_over_a_bed", runaway_over_a_bed}, {"periodic_crossing", periodic_crossing},
                                 {"runaway_against_a_block", runaway_against_a_block}, {"two_runaways", two_runaways}, {"runaways_three_boxes_apart", runaways_three_boxes_apart},
                                 {"sizes_one_to_twenty", sizes_one_to_twenty}};

class Lists : public ::testing::TestWithParam<std::tuple<Device, Adversary>> {};

TEST_P(Lists, MissNoContact) {
    const auto [device, adversary] = GetParam();
    GRAINRAY_NEEDS(device);
    Case c = adversary.make();
    Simulation lazy = c.start(device);
    c.scene.search.interval = 1;  // a fresh list every step, found by brute force
    Simulation eager = c.start(device, "brute");
    for (int batch = 0; batch < 12; ++batch) {
        lazy.run(20);
        eager.run(20);
        ASSERT_EQ(lazy.state_hash(), eager.state_hash()) << "after step " << lazy.step_count();
    }
    EXPECT_LT(lazy.search().rebuilds, eager.search().rebuilds / 2) << "the list is worth nothing here";
    EXPECT_GE(eager.search().rebuilds, 239u);
}

INSTANTIATE_TEST_SUITE_P(Adversaries, Lists, ::testing::Combine(all_devices, ::testing::ValuesIn(adversaries)), [](const auto& one) {
    return std::string(name(std::get<0>(one.param))) + "_" + std::get<1>(one.param).name;
});

/// A run of 400 steps with each trigger: safe, then published.
std::pair<Simulation, Simulation> with_both_triggers(Case c, double interval) {
    c.scene.search.skin = 0.02;
    c.scene.search.interval = interval;
    Simulation safe = c.start();
    c.scene.search.trigger = Trigger::published;
    Simulation published = c.start();
    safe.run(400);
    published.run(400);
    return {std::move(safe), std::move(published)};
}

TEST(Trigger, PublishedWaitsLonger) {
    const auto [safe, published] = with_both_triggers(column(10, 6, 8), 100);
    EXPECT_LT(published.search().rebuilds, safe.search().rebuilds);
}

TEST(Trigger, PublishedMayMissAContact) {
    const auto [safe, published] = with_both_triggers(head_on(), 10);
    EXPECT_NE(published.state_hash(), safe.state_hash()) << "the manual says that it can";
}

TEST(Lists, ACoherentFallNeedsFewRebuilds) {
    Case c = column(10, 8, 10);
    c.scene.planes.clear();
    for (auto& v : c.initial.velocities) v = {5, 0, -20};
    c.scene.search.interval = 20;
    Simulation s = c.start();
    s.run(200);
    EXPECT_LE(s.search().rebuilds, 200 / 20 + 1u);  // shared motion is no displacement
    EXPECT_LT(s.search().mean_margin_ratio, 0.1);
}

}  // namespace
}  // namespace grainray::test
