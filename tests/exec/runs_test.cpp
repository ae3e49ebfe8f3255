// Every way of testing runs of points finds what the definition says.
#include "exec/runs_cpu.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

namespace grainray::cpu::runs {
namespace {

using neighbors::Sphere;

template <bool periodic, bool owners>
std::array<Append, 2> both() { return {append<periodic, owners>, best<periodic, owners>()}; }
std::array<Append, 2> ways(bool periodic, bool owners) {
    if (periodic) return owners ? both<true, true>() : both<true, false>();
    return owners ? both<false, true>() : both<false, false>();
}

TEST(Runs, AreTestedAloneAndSixteenAtOnce) {
    std::mt19937 e(1);
    std::uniform_real_distribution<float> u(-1, 1);
    std::vector<Sphere> spheres(400);
    std::vector<std::uint32_t> ids(spheres.size()), order(spheres.size());
    for (std::size_t p = 0; p < spheres.size(); ++p) {
        spheres[p] = {u(e), u(e), u(e), p % 3 ? 0.4f : 0.3f + 0.1f * u(e)};  // two in three are equal: their ids decide
        order[p] = static_cast<std::uint32_t>((p * 271) % spheres.size());
        ids[p] = order[p] * 3 + 1;
    }
    ids[7] = 0xfffffff0u;  // ids have no sign
    std::size_t all = 0, around = 0;
    for (std::uint32_t a = 0; a < spheres.size(); ++a) {
        std::vector<runs::Run> places;
        for (std::uint32_t first = a % 5; first < spheres.size();) {
            const std::uint32_t last = std::min<std::uint32_t>(first + (first * 7 + a) % 41, static_cast<std::uint32_t>(spheres.size()));
            places.push_back({first, last});
            first = last + 1 + a % 3;
        }
        for (const Vec3f period : {Vec3f{}, Vec3f{2, 0, 2.5f}})
            for (const bool owners : {true, false}) {
                const Points points{spheres.data(), ids.data(), order.data(), period};
                std::vector<std::uint32_t> expected;
                for (const runs::Run& run : places)
                    for (std::uint32_t p = run.first; p < run.last; ++p)
                        if (neighbors::pair_test(spheres[a], spheres[p], period) && (!owners || neighbors::owns(spheres[a], ids[a], spheres[p], ids[p]))) expected.push_back(order[p]);
                std::sort(expected.begin(), expected.end());
                (period.x > 0 ? around : all) += expected.size();
                for (const Append way : ways(period.x > 0, owners)) {
                    std::vector<std::uint32_t> found(spheres.size() + 16);
                    found.resize(static_cast<std::size_t>(way(points, places.data(), places.data() + places.size(), spheres[a], ids[a], found.data()) - found.data()));
                    std::sort(found.begin(), found.end());
                    ASSERT_EQ(found, expected) << "sphere " << a;
                }
            }
    }
    EXPECT_GT(around, all);
    EXPECT_GT(all, spheres.size());
}

}  // namespace
}  // namespace grainray::cpu::runs
