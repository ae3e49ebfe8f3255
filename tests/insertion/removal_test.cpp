// Removals: what is taken out, when, and how it is listed.
#include "streams.hpp"

namespace grainray::test {
namespace {

class Removals : public ::testing::TestWithParam<Device> {
protected:
    void SetUp() override { GRAINRAY_NEEDS(GetParam()); }
};

Case flyers() {
    Case c = empty_case();
    c.scene.gravity = {};
    c.scene.contact.mass_damping = 0;
    for (int k = 0; k < 6; ++k) c.add({0, 1.0 * k, 0}, 0.1, {1.0 + k, 0, 0});
    return c;
}

TEST_P(Removals, ABoxTakesWhatEntersItAtTheNextLook) {
    Case c = flyers();
    Removal box;
    box.name = "trap";
    box.box = {{1, -0.5, -1}, {9, 3.5, 1}};
    box.steps = 20;
    c.scene.removals.push_back(box);
    Simulation simulation = c.start(GetParam());
    simulation.run(2000);
    ASSERT_EQ(simulation.lost().size(), 4u);
    for (const LostParticle& p : simulation.lost()) {
        ASSERT_LT(p.id, 4u);
        const double speed = 1.0 + p.id, steps = std::ceil(1.0 / speed / 1e-3 / 20 - 1e-6) * 20;
        EXPECT_EQ(p.step, static_cast<std::uint64_t>(steps)) << p.id;
        EXPECT_NEAR(p.time, steps * 1e-3, 1e-12);
        EXPECT_NEAR(p.position.x, speed * steps * 1e-3, 1e-6);
        EXPECT_EQ(p.position.y, p.id);
        EXPECT_EQ(p.velocity.x, static_cast<float>(speed));
        EXPECT_NEAR(p.radius, 0.1, 1e-7);
        EXPECT_EQ(p.removal, 0u);
    }
    EXPECT_EQ(simulation.frame().id, (std::vector<std::uint32_t>{4, 5}));
    EXPECT_EQ(simulation.removals()[0].particles, 4u);
    simulation.forget_lost();
    EXPECT_TRUE(simulation.lost().empty());
    EXPECT_EQ(simulation.removals()[0].particles, 4u);
}

TEST_P(Removals, OutsideOfTheDomainIsNoFailureThen) {
    Case c = flyers();
    c.scene.domain.box = Box{{-1, -1, -1}, {2, 6, 1}};
    Simulation strict = c.start(GetParam());
    strict.run(1000);
    EXPECT_THROW(strict.check_health(), SimulationError);
    Removal outside;
    outside.name = "rest";
    outside.region = RemovalRegion::outside;
    c.scene.removals.push_back(outside);
    Simulation simulation = c.start(GetParam());
    for (int k = 0; k < 90; ++k) {
        simulation.run(10);
        simulation.check_health();
    }
    EXPECT_EQ(simulation.frame().id, (std::vector<std::uint32_t>{0, 1}));
    EXPECT_EQ(simulation.lost().size(), 4u);
}

TEST_P(Removals, SurvivorsKeepTheirContacts) {
    Case c = column(10, 4, 10);
    c.scene.removals.push_back(half_space("front", {1.5, 0, 0}, {1, 0, 0}, 60));
    Simulation whole = c.start(GetParam());
    whole.run(299);
    const Checkpoint before = whole.checkpoint();
    whole.run(1);
    const Checkpoint after = whole.checkpoint();
    ASSERT_LT(after.id.size(), before.id.size());
    EXPECT_GT(after.contact_history.size(), 200u);
    for (const std::uint32_t id : after.contact_a) ASSERT_TRUE(std::binary_search(after.id.begin(), after.id.end(), id));
    // The same step without the removal: what stays has the same histories.
    Case calm = c;
    calm.scene.removals.clear();
    Simulation one(calm.scene, before, {GetParam(), "brute", 0});
    one.run(1);
    const Checkpoint all = one.checkpoint();
    std::size_t k = 0, kept = 0;
    for (std::size_t e = 0; e < all.contact_a.size(); ++e) {
        if (!std::binary_search(after.id.begin(), after.id.end(), all.contact_a[e]) || !std::binary_search(after.id.begin(), after.id.end(), all.contact_b[e])) continue;
        ASSERT_LT(k, after.contact_a.size());
        ASSERT_EQ(after.contact_a[k], all.contact_a[e]);
        ASSERT_EQ(after.contact_b[k], all.contact_b[e]);
        ASSERT_EQ(after.contact_history[k], all.contact_history[e]);
        ++k, ++kept;
    }
    EXPECT_EQ(kept, after.contact_a.size());
    EXPECT_EQ(after.wall_history.size() > 0, true);
}

INSTANTIATE_TEST_SUITE_P(Devices, Removals, all_devices, device_name);

}  // namespace
}  // namespace grainray::test
