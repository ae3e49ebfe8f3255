// Fixed-point sums: nearest rounding, odd symmetry, bounds.
#include "contacts/wrench.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace grainray::test {
namespace {

TEST(Quantize, RoundsToTheNearestAndIsOdd) {
    for (const float v : {0.0f, 0.4f, 0.5f, 0.6f, 1.5f, 2.5f, 1e6f, 123456.78f}) {
        EXPECT_EQ(quantize(v, 1.0), std::llrint(static_cast<double>(v)));
        EXPECT_EQ(quantize(-v, 1.0), -quantize(v, 1.0));
    }
    EXPECT_EQ(quantize(0.3f, 1024.0), std::llrint(static_cast<double>(0.3f) * 1024));
}

TEST(Quantize, HoldsToItsBoundAndShowsNan) {
    constexpr std::int64_t bound = std::int64_t{1} << 50;
    EXPECT_EQ(quantize(1e30f, 1e10), bound);
    EXPECT_EQ(quantize(-1e30f, 1e10), -bound);
    EXPECT_EQ(std::abs(quantize(std::numeric_limits<float>::quiet_NaN(), 1.0)), bound);
}

TEST(Quanta, ResolveTheWeightOfASpeckBesideABoulder) {
    const Quanta q = Quanta::for_scale(1e7, 0.1);
    EXPECT_LT(q.force, 1e-8);
    EXPECT_LT(2 * 1e7 * 0.1 / q.force, 1125899906842624.0);  // twice the largest radius of overlap still fits
    EXPECT_EQ(q.force, std::ldexp(1.0, std::ilogb(q.force)));
}

}  // namespace
}  // namespace grainray::test
