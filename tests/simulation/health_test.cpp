// When a run goes wrong it stops and says which particle, and statistics say what is so.
#include "devices.hpp"
#include "scenes.hpp"

namespace grainray::test {
namespace {

std::string failure(const Simulation& s) {
    try {
        s.check_health();
    } catch (const SimulationError& e) {
        return e.what();
    }
    return "healthy";
}

TEST(Health, NearlyCoincidentStiffSpheresAreNamed) {
    Case c = empty_case();
    c.add({0, 0, 1}, 0.1);
    c.add({0, 0.5, 1}, 0.1);
    c.add({0, 0.5 + 1e-4, 1}, 0.1);
    Simulation s = c.start();
    s.step();
    const std::string message = failure(s);
    EXPECT_NE(message.find("overlap"), std::string::npos) << message;
    EXPECT_NE(message.find("particle 1"), std::string::npos) << message;
    EXPECT_NE(message.find("particle 2"), std::string::npos) << message;
    EXPECT_NE(message.find("critical dt"), std::string::npos) << message;
}

TEST(Health, SpeedLimitIsNamed) {
    Case c = empty_case();
    c.add({0, 0, 1}, 0.1, {0, 0, 150});
    EXPECT_NE(failure(c.start()).find("limits.speed"), std::string::npos);
    c.scene.limits.speed = 200;
    EXPECT_EQ(failure(c.start()), "healthy");
}

TEST(Health, LeavingTheDomainIsNamed) {
    Case c = empty_case();
    c.scene.domain.box = Box{{-1, -1, -1}, {1, 1, 1}};
    c.add({0, 0.5, 0}, 0.1, {0, 30, 0});
    Simulation s = c.start();
    EXPECT_EQ(failure(s), "healthy");
    s.run(50);
    EXPECT_NE(failure(s).find("domain was left along y"), std::string::npos) << failure(s);
}

TEST(Health, UnstableStepBlowsUpAndIsCaught) {
    Case c = column(6, 6, 6);
    c.scene.materials[0].normal_stiffness = 1e9;
    Simulation s = c.start();
    std::string message = "healthy";
    for (int k = 0; k < 20 && message == "healthy"; ++k) {
        s.run(10);
        message = failure(s);
    }
    EXPECT_NE(message.find("stopped at t ="), std::string::npos);
    EXPECT_NE(message.find("Lower simulation.dt"), std::string::npos) << message;
}

TEST(Health, NanVelocityIsCaught) {
    Case c = column(3, 3, 3);
    c.initial.velocities[4].x = NAN;
    Simulation s = c.start();
    s.run(2);
    EXPECT_NE(failure(s).find("particle 4 "), std::string::npos) << failure(s);
}

TEST(Statistics, AddUp) {
    Case c = empty_case();
    c.add({1, 2, 3}, 0.1, {1, 0, 0}, {0, 0, 2});
    c.add({1.19, 2, 3}, 0.1, {0, -2, 0});
    const double m = 4.0 / 3.0 * 3.14159265358979 * 1e-3 * 2000;
    Simulation s = c.start();
    const Statistics before = s.statistics();
    EXPECT_NEAR(before.kinetic_translation, 0.5 * m * 5, 1e-5);
    EXPECT_NEAR(before.kinetic_rotation, 0.5 * 0.4 * m * 0.01 * 4, 1e-6);
    EXPECT_NEAR(before.potential, 2 * m * 10 * 3, 1e-4);
    EXPECT_NEAR(before.momentum.y, -2 * m, 1e-5);
    EXPECT_NEAR(before.angular_momentum.z, m * (1.19 * -2 - 2 * 1) + 0.4 * m * 0.01 * 2, 1e-4);
    s.step();
    const Statistics after = s.statistics();
    EXPECT_EQ(after.contacts, 1u);
    EXPECT_NEAR(after.coordination, 1, 1e-12);
    EXPECT_NEAR(after.max_overlap_ratio, 0.1, 0.02);
}

TEST(Frames, ComeInOrderOfIdWithContactForces) {
    Case c = empty_case();
    for (int i = 0; i < 2000; ++i) c.add({0.3 * (i * 37 % 2000 % 50), 0.3 * (i * 37 % 2000 / 50), 0.09}, 0.1);
    c.scene.materials[1].normal_stiffness = 1e5;
    c.plane("floor", {0, 0, 0}, {0, 0, 1});
    Simulation s = c.start();
    s.run(1);
    const Frame f = s.frame();
    for (std::size_t i = 0; i < f.size(); ++i) {
        ASSERT_EQ(f.id[i], i);
        ASSERT_NEAR(f.position[i].x, c.initial.positions[i].x, 1e-9);
        ASSERT_EQ(f.coordination[i], 1u);
        ASSERT_GT(f.contact_force[i], 500);  // k u = 1e5 * 0.01 less the dashpot
    }
}

}  // namespace
}  // namespace grainray::test
