// The policy of `auto`, with times told instead of measured.
#include <gtest/gtest.h>

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
        const auto due = choice.due(now);
        if (due.empty()) {
            choice.searched(seconds[choice.best()]);
            total += seconds[choice.best()];
            return;
        }
        double round = 0;
        for (const std::size_t c : due) {
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

}  // namespace
}  // namespace grainray::neighbors
