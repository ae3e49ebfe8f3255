// The yardstick and the report themselves: a measure that cannot fail measures nothing.
#include "validation/yardstick.hpp"

#include <gtest/gtest.h>

#include "validation/cases.hpp"

namespace grainray::test {
namespace {

using namespace validation;

/// A sphere that slides on a floor, in equilibrium across it.
Yardstick sliding(double dt) {
    Yardstick y;
    y.dt = dt;
    y.gravity = {0, 0, -10};
    y.wall = {1e5, 5e4, 0.3, 0.2, 0.1};
    y.walls = {{}};
    y.spheres = {{{0, 0, 0.0995}, {1, 0.5, 0}, {0, 3, 0}, 0.1, 5}};
    return y;
}

TEST(Yardstick, ConvergesAtFirstOrder) {
    const auto position = [](double dt) {
        Yardstick y = sliding(dt);
        y.run(static_cast<int>(std::lround(0.1 / dt)));
        return y.spheres[0].x;
    };
    const Vec3d exact = position(1e-6);
    const double coarse = length(position(1e-4) - exact), fine = length(position(5e-5) - exact);
    EXPECT_NEAR(coarse / fine, 2, 0.15);
    EXPECT_LT(fine, 5e-5);
}

TEST(Yardstick, FrictionTakesWhatCoulombAllows) {
    Yardstick y = sliding(1e-4);
    const Vec3d before = y.spheres[0].v;
    y.run(200);
    EXPECT_NEAR(length(before - y.spheres[0].v), 0.3 * 10 * 0.02, 1e-3);
}

TEST(Report, CountsNaNAndMissedTolerancesAsFailures) {
    Report report("a case", {});
    report.relative("inside", 100, 100.9, 0.01, "test");
    report.relative("outside", 100, 101.1, 0.01, "test");
    report.relative("negative", -100, -100.9, 0.01, "test");
    report.absolute("nan", 0, NAN, 1e9, "test");
    report.absolute("exact", 3, 3, 0, "test");
    report.shown("shown", 1, 2, "test");
    const std::vector<bool> expected{true, false, true, false, true, true};
    ASSERT_EQ(report.results.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(report.results[i].pass, expected[i]) << report.results[i].quantity;
    EXPECT_FALSE(report.results.back().gated);
}

TEST(Compare, SeesAWrongStiffness) {
    Trial t(1e-4, {}, {1e5, 0, 0, 0.1, 0});
    t.plane({}, {0, 0, 1});
    t.sphere({0, 0, 0.1}, {0, 0, -1});
    t.yardstick.wall.kn *= 1.001;
    Report report("a case", {});
    Simulation s = t.start(report);
    s.run(300);
    t.yardstick.run(300);
    compare(report, "after", s, t.yardstick, 1e-5, 1e-5);
    EXPECT_FALSE(report.results[0].pass);
}

}  // namespace
}  // namespace grainray::test
