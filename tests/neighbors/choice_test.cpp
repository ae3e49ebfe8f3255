// The policy of `auto`, with times told instead of measured.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "grainray/neighbors.hpp"
#include "neighbors/choice.hpp"

namespace grainray::neighbors {
namespace {

const Facts million{1e6, 1e7, 1.2, 1};

/// A world in which a search takes these seconds; returns the seconds an update took.
struct World {
    Choice choice{{"cells", "rays"}};
    double seconds[2] = {1e-3, 2e-3};
    double total = 0, best_fixed = 0;
    int measurements = 0;

    void search(const Facts& now) {
        best_fixed += std::min(seconds[0], seconds[1]);
        if (!choice.due(now)) {
            choice.searched(seconds[choice.best()]);
            total += seconds[choice.best()];
            return;
        }
        double round = 0;
        for (const std::size_t c : choice.contenders(now)) {
            choice.measured(c, seconds[c], now);
            round += 2 * seconds[c];
            ++measurements;
        }
        choice.finished_round(round);
        total += round;
    }
};

TEST(Choice, TakesTheFastestAndSaysSo) {
    World w;
    w.search(million);
    EXPECT_EQ(w.choice.candidates()[w.choice.best()].name, "cells");
    EXPECT_EQ(w.choice.reason(), "measured 1 ms a search against 2 ms by rays");
    World other;
    std::swap(other.seconds[0], other.seconds[1]);
    other.search(million);
    EXPECT_EQ(other.choice.candidates()[other.choice.best()].name, "rays");
}

TEST(Choice, MeasuresNothingWhileThePointsStayAlike) {
    World w;
    for (int k = 0; k < 1000; ++k) w.search(million);
    EXPECT_EQ(w.measurements, 2);
    EXPECT_LT(w.total, 1.05 * w.best_fixed);
}

TEST(Choice, FollowsPointsThatChange) {
    World w;
    for (int k = 0; k < 1000; ++k) w.search(million);
    Facts wide = million;
    wide.spread = 9;
    w.seconds[0] = 9e-3;
    for (int k = 0; k < 100; ++k) w.search(wide);
    EXPECT_EQ(w.choice.candidates()[w.choice.best()].name, "rays");
}

TEST(Choice, RestlessPointsCostFivePercentAtMost) {
    World w;
    for (int k = 0; k < 5000; ++k) {
        Facts f = million;
        f.entries *= 1 + k % 7;  // never alike for long
        w.search(f);
    }
    EXPECT_GT(w.measurements, 4);
    EXPECT_LT(w.total, 1.05 * w.best_fixed);
}

TEST(Choice, TheHopelessAreNotMeasuredTwice) {
    World w;
    w.seconds[1] = 1;
    w.search(million);
    for (int k = 0; k < 5000; ++k) {
        Facts f = million;
        f.entries *= 1 + k % 2;
        w.search(f);
    }
    EXPECT_EQ(w.measurements, 2);
    EXPECT_TRUE(w.choice.out_of_the_race(0.1));
    EXPECT_FALSE(w.choice.out_of_the_race(0.01));
}

TEST(Choice, WhoCannotWinIsLeftOutUntilPointsChange) {
    Choice choice({"cells", "rays"});
    ASSERT_TRUE(choice.due(million));
    choice.left_out(1, "cells look at 60 points for each");
    choice.measured(0, 1e-3, million);
    choice.finished_round(1e-3);
    EXPECT_EQ(choice.reason(), "rays left out: cells look at 60 points for each");
    EXPECT_FALSE(choice.due(million));
    for (int k = 0; k < 1000; ++k) choice.searched(1e-3);
    Facts wide = million;
    wide.spread = 9;
    ASSERT_TRUE(choice.due(wide));
    EXPECT_EQ(choice.contenders(wide).size(), 2u);
    choice.measured(0, 9e-3, wide);
    choice.measured(1, 2e-3, wide);
    choice.finished_round(22e-3);
    EXPECT_EQ(choice.reason(), "measured 2 ms a search against 9 ms by cells");
}

/// Half of the points a dense lump among the other half, large ones far apart: then cells of the mean size hold hundreds.
std::vector<float> lump_and_gas(std::size_t n, float density, std::vector<float>& reach) {
    std::mt19937_64 e(3);
    std::uniform_real_distribution<float> u(0, std::cbrt(static_cast<float>(n)));
    std::vector<float> xyz;
    for (std::size_t i = 0; i < n; ++i) {
        const bool dense = i % 2;
        for (int a = 0; a < 3; ++a) xyz.push_back(dense ? u(e) / density : u(e));
        reach.push_back(dense ? 0.65f / density : 0.65f);
    }
    return xyz;
}

TEST(Auto, MeasuresRaysOnTheCpuWhereTheyCanWin) {
    for (const float density : {1.0f, 16.0f}) {
        std::vector<float> reach;
        const auto xyz = lump_and_gas(8000, density, reach);
        const float* x = xyz.data();
        const Points points{x, x + 1, x + 2, 3, reach.data(), 1, 0, nullptr, reach.size()};
        NeighborSearch search, cells(Device::cpu, {.backend = "cells"});
        NeighborList found, expected;
        search.find(points, found);
        cells.find(points, expected);
        EXPECT_EQ(found.neighbors.to_host(), expected.neighbors.to_host());
        if (density == 1) {  // else what was faster just now
            EXPECT_EQ(search.backend(), "cells") << search.reason();
        }
        EXPECT_EQ(search.reason().find("left out") != std::string::npos, density == 1) << search.reason();
    }
}

}  // namespace
}  // namespace grainray::neighbors
