// The linear law: closed forms of each term, and the exact antisymmetry that lets each side compute its own half.
#include "contacts/linear.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "contacts/pair.hpp"

namespace grainray::test {
namespace {

constexpr PairParameters steel{1e5f, 0.7e5f, 0.5f, 30.0f, 7.0f};

TEST(LinearLaw, SpringAndDashpot) {
    Vec3f history;
    const Vec3f f = LinearLaw{1e-3f}({{0, 0, 1}, 0.01f, {0, 0, -2}, 4.0f}, steel, history);
    EXPECT_FLOAT_EQ(f.z, 1e5f * 0.01f + 30.0f * 2.0f * 2.0f);
    EXPECT_EQ(f.x, 0);
    EXPECT_EQ(history, Vec3f{});
}

TEST(LinearLaw, TangentialSpringAddsUpUntilItSlides) {
    const PairParameters p{1e5f, 1e5f, 0.5f, 0, 0};
    Vec3f history;
    const Contact c{{0, 0, 1}, 0.01f, {1, 0, 0}, 1};
    for (int step = 1; step <= 4; ++step) EXPECT_FLOAT_EQ(LinearLaw{1e-3f}(c, p, history).x, -100.0f * static_cast<float>(step));
    for (int step = 0; step < 10; ++step) LinearLaw{1e-3f}(c, p, history);
    EXPECT_FLOAT_EQ(history.x, -500.0f);  // mu f_n
}

TEST(LinearLaw, ViscousPartStaysInsideTheCoulombCap) {
    const PairParameters p{1e5f, 1e5f, 0.5f, 0, 1000.0f};
    Vec3f history;
    const Vec3f f = LinearLaw{1e-3f}({{0, 0, 1}, 0.01f, {50, 0, 0}, 1}, p, history);
    EXPECT_FLOAT_EQ(f.x, -500.0f);
}

TEST(LinearLaw, HistoryTurnsWithTheContactAndKeepsItsSize) {
    const PairParameters p{1e5f, 1e5f, 10.0f, 0, 0};
    Vec3f history{300, 0, 0};
    const float s = std::sin(0.3f), c = std::cos(0.3f);
    LinearLaw{1e-3f}({{s, 0, c}, 0.01f, {0, 0, 0}, 1}, p, history);
    EXPECT_NEAR(length(history), 300, 1e-3);
    EXPECT_NEAR(dot(history, Vec3f{s, 0, c}), 0, 1e-3);
    EXPECT_NEAR(history.x, 300 * c, 1e-2);
}

TEST(LinearLaw, NoHistoryNoMotionNoTangentialForce) {
    Vec3f history;
    const Vec3f f = LinearLaw{1e-3f}({{0.6f, 0, 0.8f}, 0.01f, {}, 1}, steel, history);
    EXPECT_NEAR(length(cross(f, Vec3f{0.6f, 0, 0.8f})), 0, 1e-4);
}

/// Two grains seen from each side: force and torque must be the same bits with the signs the other side needs.
TEST(PairForce, EachSideComputesTheSameBits) {
    std::mt19937 e(5);
    std::uniform_real_distribution<float> u(-1, 1);
    std::uniform_int_distribution<std::int32_t> place(-40'000'000, 40'000'000);
    const auto vector = [&](float s) { return Vec3f{s * u(e), s * u(e), s * u(e)}; };
    for (int k = 0; k < 20000; ++k) {
        const Near a{place(e), place(e), place(e), 67'000'000}, b{place(e), place(e), place(e), 70'123'456};
        const Separation ab = separation(a, b), ba = separation(b, a);
        ASSERT_EQ(ab.gap, ba.gap);
        if (ab.gap <= 0) continue;
        const Vec3f v = vector(3), wa = vector(20), wb = vector(20);
        Vec3f ha = vector(100), hb = -ha;
        const float unit = 1.4901161e-9f;
        const PairForce fa = pair_force(LinearLaw{1e-3f}, ab, a.radius, b.radius, v, wa, wb, 3.0f, steel, unit, ha);
        const PairForce fb = pair_force(LinearLaw{1e-3f}, ba, b.radius, a.radius, -v, wb, wa, 3.0f, steel, unit, hb);
        for (int axis = 0; axis < 3; ++axis) {
            ASSERT_EQ(fa.force[axis], -fb.force[axis]);
            ASSERT_EQ(fa.torque_i[axis], fb.torque_j[axis]);
            ASSERT_EQ(fa.torque_j[axis], fb.torque_i[axis]);
            ASSERT_EQ(ha[axis], -hb[axis]);
        }
    }
}

TEST(PairForce, OverlapHasNoCancellation) {
    // An overlap of two units in radii of 1e8: exact as an integer, where r_i + r_j - d in floats would give 0 or 16.
    const Near a{0, 0, 0, 100'000'000}, b{199'999'998, 0, 0, 100'000'000};
    Vec3f h;
    const PairForce f = pair_force(LinearLaw{0}, separation(a, b), a.radius, b.radius, {}, {}, {}, 1, {1, 0, 0, 0, 0}, 1.0f, h);
    EXPECT_NEAR(f.force.x, -2.0, 1e-6);
}

TEST(PairForce, CoincidentCentresGiveNoForceAndNoNan) {
    const Near a{5, 5, 5, 1000};
    Vec3f h;
    const PairForce f = pair_force(LinearLaw{1e-3f}, separation(a, a), 1000, 1000, {1, 2, 3}, {}, {}, 1, steel, 1.0f, h);
    EXPECT_EQ(f.torque_i, Vec3f{});
    EXPECT_TRUE(std::isfinite(f.force.x) && std::isfinite(f.force.y) && std::isfinite(f.force.z));
}

TEST(Separation, NearWordsWrapExactly) {
    const Near a{2147483600, -2147483648, 7, 100}, b{-2147483600, 2147483600, 7, 100};
    const Separation s = separation(a, b);
    EXPECT_EQ(s.x, -96);
    EXPECT_EQ(s.y, 48);
    EXPECT_EQ(s.gap, 200 * 200 - 96 * 96 - 48 * 48);
}

}  // namespace
}  // namespace grainray::test
