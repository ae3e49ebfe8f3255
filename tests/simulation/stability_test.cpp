// The forecast of the critical time step against what the integrator does.
#include <gtest/gtest.h>

#include "scenes.hpp"

namespace grainray::test {
namespace {

const CriticalStep& find(const std::vector<CriticalStep>& steps, const std::string& contact) {
    for (const auto& s : steps)
        if (s.contact == contact) return s;
    throw std::runtime_error("no contact " + contact);
}

Case table(bool literal) {
    Case c = empty_case();
    c.add({0, 0, 1}, 0.1);
    c.plane("floor", {}, {0, 0, 1});
    if (literal) {
        c.scene.materials[1].tangential_stiffness = 1e7;
        for (auto& m : c.scene.materials) m.tangential_damping = 0.5;
    }
    return c;
}

TEST(CriticalStep, StableReadingPassesAtAMillisecond) {
    const Case c = table(false);
    const auto steps = critical_steps(c.scene, c.initial);
    EXPECT_GT(steps.front().critical_dt, 1e-3);
    EXPECT_NEAR(find(steps, "grain-wall plane, normal").critical_dt, 1.236 * std::sqrt(8.3776 / 1e7), 2e-6);
    EXPECT_NEAR(find(steps, "grain-wall plane, tangential").critical_dt, 2 / std::sqrt(3.5 * 2.857143e6 / 8.3776), 2e-6);
}

TEST(CriticalStep, LiteralTableFailsAtAMillisecondAndNamesTheFields) {
    const Case c = table(true);
    const auto steps = critical_steps(c.scene, c.initial);
    EXPECT_LT(steps.front().critical_dt, 1e-3);
    EXPECT_GT(steps.front().critical_dt, 2e-4);
    EXPECT_EQ(steps.front().contact, "grain-wall plane, tangential");
    EXPECT_EQ(steps.front().field.rfind("materials.wall.tangential_", 0), 0u) << steps.front().field;
    EXPECT_LT(find(steps, "grain-grain, bed of 6 contacts, tangential").critical_dt, 1e-3);
    EXPECT_EQ(find(steps, "grain-grain, bed of 6 contacts, tangential").field, "materials.grain.tangential_damping");
}

/// Kept in contact by its own start, a sphere on a plane must be quiet just below the limit and grow just above it.
TEST(CriticalStep, IsWhereTheIntegratorTurnsUnstable) {
    for (const double share : {0.97, 1.03}) {
        Case c = table(false);
        c.scene.gravity = {};
        c.scene.contact.mass_damping = 0;
        c.scene.limits.speed = 1e30;
        c.initial.positions[0].z = 0.05;  // the plane's force may pull as well as push, so the contact stays linear
        c.scene.planes.push_back({"lid", "wall", {0, 0, 0.1}, {0, 0, -1}, {}});
        // Two planes: twice the stiffness and damping on one mass.
        const double m = 4.0 / 3.0 * 3.14159265358979 * 1e-3 * 2000, k = 2e7, d = 2 * 2 * 0.5 * std::sqrt(m * 1e7);
        c.scene.dt = share * (std::sqrt(d * d + 4 * k * m) - d) / k;
        c.initial.velocities[0].z = 0.1;
        Simulation s = c.start();
        s.run(15);
        const double early = s.statistics().max_speed;
        s.run(15);
        if (share < 1) EXPECT_LT(s.statistics().max_speed, early);
        else EXPECT_GT(s.statistics().max_speed, early);
    }
}

}  // namespace
}  // namespace grainray::test
