// The analysis of deposits: a wedge of known angle, and the figures of benchmarks/peers/common/deposit.py for one cloud.
#include "validation/deposit.hpp"

#include <gtest/gtest.h>

#include "validation/column.hpp"

namespace grainray::test {
namespace {

using namespace validation;

constexpr double r = 0.1, pi = 3.14159265358979323846;

/// Bins of width 2 r hold the mass of a wedge of height h(x) = height (1 - x / length); the top sphere of each touches it.
std::vector<Vec3d> wedge(double height, double length, const Channel& c) {
    std::vector<Vec3d> centres;
    const double volume = 4.0 / 3.0 * pi * r * r * r;
    for (double x = r; x < length; x += 2 * r) {
        const double h = height * (1 - x / length);
        const auto count = static_cast<int>(std::lround(h * 2 * r * c.width * 0.6 / volume));
        for (int k = 0; k < count; ++k) centres.push_back({x, 0, h - r - (h - 2 * r) * k / count});
    }
    return centres;
}

TEST(Deposit, MeasuresTheAngleOfAWedge) {
    const Channel c{r, 40, 8};
    for (const double degrees : {10.0, 20.0, 27.4, 35.0}) {
        const double height = 6, length = height / std::tan(degrees * pi / 180);
        const Deposit d = measure(wedge(height, length, c), c);
        EXPECT_NEAR(d.angle_top, degrees, 1e-6);
        EXPECT_NEAR(d.r2_top, 1, 1e-12);
        EXPECT_NEAR(d.angle_mass, degrees, 0.02);
        EXPECT_NEAR(d.angle_steep, degrees, 1e-6);
        EXPECT_NEAR(d.x_edge, length * (1 - 4 * r / height), 0.01) << degrees;
        EXPECT_NEAR(d.x_toe, length * (1 - 2 * r / height), 2 * r) << degrees;  // the mean over 5 bins reaches past the tip
        EXPECT_NEAR(d.h_wall, height * (1 - 5 * r / length), 1e-9);
        EXPECT_NEAR(d.angle_secant, std::atan(d.h_wall / d.x_edge) * 180 / pi, 1e-12);
    }
}

/// 4000 spheres from a fixed linear congruential generator, heaped towards the wall, with a few lone ones.
std::vector<Vec3d> cloud() {
    std::uint64_t state = 12345;
    const auto next = [&] {
        state = (state * 6364136223846793005ull + 1442695040888963407ull) & 0xffffffffffffffffull;
        return static_cast<double>(state >> 33) / 2147483648.0;
    };
    std::vector<Vec3d> centres;
    for (int k = 0; k < 4000; ++k) {
        const double a = next(), b = next(), c = next();
        const double x = k < 3990 ? 9 * (1 - std::sqrt(1 - a)) : 8 + 6 * a;
        centres.push_back({x, 2.4 * b, 0.1 + c * std::max(0.0, 3 * (1 - x / 9))});
    }
    return centres;
}

TEST(Deposit, AgreesWithTheScriptOfThePeers) {
    const Deposit d = measure(cloud(), Column{12, 10, 30, 0}.channel());
    // python3 benchmarks/peers/common/deposit.py CLOUD.csv 12x10x30
    EXPECT_NEAR(d.x_edge, 7.68411, 1e-4);
    EXPECT_NEAR(d.x_toe, 8.29314, 1e-4);
    EXPECT_NEAR(d.x_50, 2.69099, 1e-4);
    EXPECT_NEAR(d.x_95, 7.07738, 1e-4);
    EXPECT_NEAR(d.x_99, 8.13111, 1e-4);
    EXPECT_NEAR(d.x_max, 13.697, 1e-4);
    EXPECT_NEAR(d.z_mean, 1.10179, 1e-5);
    EXPECT_NEAR(d.h_wall, 3.03327, 1e-5);
    EXPECT_NEAR(d.angle_secant, 21.5414, 1e-3);
    EXPECT_NEAR(d.angle_top, 18.5501, 1e-3);
    EXPECT_NEAR(d.r2_top, 0.998321, 1e-5);
    EXPECT_NEAR(d.angle_mass, 14.7976, 1e-3);
    EXPECT_NEAR(d.r2_mass, 0.915211, 1e-5);
    EXPECT_NEAR(d.angle_steep, 21.4814, 1e-3);
}

TEST(Deposit, OneSphereHasNoAngle) {
    const Deposit d = measure({{0.3, 0, 0.1}}, {r, 1, 1});
    EXPECT_TRUE(std::isnan(d.angle_top));
    EXPECT_TRUE(std::isnan(d.angle_steep));
    EXPECT_NEAR(d.x_max, 0.3, 1e-12);
    EXPECT_THROW(measure({}, {r, 1, 1}), Error);
}

}  // namespace
}  // namespace grainray::test
