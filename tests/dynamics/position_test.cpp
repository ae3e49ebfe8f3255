// Fixed-point positions: two words an axis that join to one 64-bit integer.
#include "grainray/particles.hpp"

#include <gtest/gtest.h>

#include <random>

namespace grainray::test {
namespace {

TEST(Position, SplitsAndJoinsEveryValue) {
    std::mt19937_64 e(3);
    for (int k = 0; k < 100000; ++k) {
        const auto p = static_cast<std::int64_t>(e());
        ASSERT_EQ(join(near_of(p), far_of(p)), p);
    }
    for (const std::int64_t p : {std::int64_t{0}, std::int64_t{-1}, std::int64_t{1} << 43, -(std::int64_t{1} << 43), INT64_MAX, INT64_MIN})
        EXPECT_EQ(join(near_of(p), far_of(p)), p);
}

TEST(Position, NearWordsCarryTheDifference) {
    const std::int64_t p = (std::int64_t{1} << 60) + 12345678, q = p - (std::int64_t{3} << 36);
    EXPECT_EQ(near_of(p) - near_of(q), static_cast<std::int32_t>((p >> fine_bits) - (q >> fine_bits)));
}

TEST(PositionScale, RadiusHas26To27Bits) {
    for (const double r : {1e-6, 0.37e-3, 0.1, 0.125, 3.0, 1e4}) {
        const PositionScale s = PositionScale::for_radius(r, {});
        EXPECT_GT(r / s.unit, 67108863.0) << r;
        EXPECT_LE(r / s.unit, 134217728.0) << r;
    }
}

TEST(PositionScale, RoundTripIsExactToAFineUnit) {
    const PositionScale s = PositionScale::for_radius(0.1, {2e5, 1e4, -3e3});
    const Vec3d x{2e5 + 1499.123456789, 1e4 - 0.3, -3e3 + 1e-9};
    const Vec3d back = s.world(s.fixed(x));
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(back[a], x[a], 4e-11);  // the double's own spacing at 2e5
}

TEST(PositionScale, OutsideTheWorldIsRefused) {
    const PositionScale s = PositionScale::for_radius(1e-3, {});
    EXPECT_NO_THROW(s.fixed({1e4, 0, 0}));
    EXPECT_THROW(s.fixed({1e9, 0, 0}), InputError);
    EXPECT_THROW(s.fixed({NAN, 0, 0}), InputError);
}

}  // namespace
}  // namespace grainray::test
