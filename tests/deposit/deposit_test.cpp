// Depth maps, profiles and run-out of arrangements whose answers are known.
#include <gtest/gtest.h>
#include <map>
#include <numbers>
#include <numeric>

#include "deposit/deposit.hpp"
#include "deposit/share.hpp"
#include "surfaces/surfaces.hpp"

namespace grainray::deposit {
namespace {

constexpr double ball = 4.0 / 3.0 * std::numbers::pi;

/// Level ground of 5 x 4 cells of 10 m, far from zero.
ElevationGrid level(double height = 100) { return {5, 4, 20000, 100000, 10, 10, std::vector<double>(20, height)}; }

void add(Frame& frame, const Vec3d& p, float radius, const Vec3f& velocity = {}) {
    frame.position.push_back(p);
    frame.radius.push_back(radius);
    frame.velocity.push_back(velocity);
}

double sum(const ElevationGrid& map) {
    return std::accumulate(map.heights.begin(), map.heights.end(), 0.0, [](double s, double v) { return std::isnan(v) ? s : s + v; });
}

TEST(Share, AddsUpAndIsSymmetrical) {
    const CellLine x{0, 1}, y{0, 2};
    for (const auto& [px, py, r] : {std::tuple{0.2, 0.3, 0.1}, {0.5, 1.0, 0.4}, {0.3, 0.9, 2.7}, {-3.1, 4.2, 1.0}, {0.45, 0.2, 0.1}}) {
        double whole = 0;
        share_sphere(x, y, px, py, r, [&](std::int64_t, std::int64_t, double share) {
            EXPECT_GE(share, -1e-12);
            whole += share;
        });
        EXPECT_NEAR(whole, 1, 1e-12) << px;
    }
    std::vector<double> quarters;
    share_sphere(x, y, 0.5, 1.0, 0.4, [&](std::int64_t, std::int64_t, double share) { quarters.push_back(share); });  // on a corner
    ASSERT_EQ(quarters.size(), 4u);
    for (const double q : quarters) EXPECT_NEAR(q, 0.25, 1e-12);
}

TEST(Share, CapsAreThoseOfABall) {
    // The part beyond an edge at distance r/2 from the centre is a cap of height r/2: 5/32 of the ball.
    for (const bool along_x : {true, false}) {
        double cap = 0;
        const auto take = [&](std::int64_t i, std::int64_t j, double share) {
            if ((along_x ? i : j) == 1) cap = share;
        };
        if (along_x) share_sphere(CellLine{0, 1}, CellLine{0, 100}, 0.4, 0, 0.2, take);
        else share_sphere(CellLine{0, 100}, CellLine{0, 1}, 0, 0.4, 0.2, take);
        EXPECT_NEAR(cap, 5.0 / 32, 1e-12);
    }
}

TEST(Share, CornersAgreeWithCounting) {
    // Cells about (0.37, 0.21) of a ball of radius 0.8, against a sum over a fine lattice of points.
    constexpr int n = 200;
    constexpr double cx = 0.37, cy = 0.21, r = 0.8;
    std::map<std::pair<std::int64_t, std::int64_t>, double> counted;
    double whole = 0;
    for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) {
            const double u = (a + 0.5) / n * 2 - 1, v = (b + 0.5) / n * 2 - 1, left = 1 - u * u - v * v;
            if (left <= 0) continue;
            counted[{std::llround(cx + r * u), std::llround(cy + r * v)}] += std::sqrt(left);
            whole += std::sqrt(left);
        }
    share_sphere(CellLine{0, 1}, CellLine{0, 1}, cx, cy, r, [&](std::int64_t i, std::int64_t j, double share) {
        EXPECT_NEAR(share, counted[std::pair(i, j)] / whole, 2e-3) << i << ' ' << j;
    });
}

TEST(Maps, KnownArrangement) {
    const ElevationGrid ground = level();
    Frame frame;
    add(frame, {20010, 100010, 101}, 1, {3, 0, 0});      // in the middle of cell (1, 1)
    add(frame, {20010, 100010, 103}, 1, {0, 0, -1});     // on top of it
    add(frame, {20025, 100020, 101}, 1, {0, 2, 0});      // on the edge of (2, 2) and (3, 2)
    const Maps maps = map(frame, ground, ground, 0.6);
    EXPECT_NEAR(maps.depth.at(1, 1), 2 * ball / 60, 1e-9);
    EXPECT_NEAR(maps.depth.at(2, 2), 0.5 * ball / 60, 1e-9);
    EXPECT_NEAR(maps.depth.at(3, 2), 0.5 * ball / 60, 1e-9);
    EXPECT_NEAR(sum(maps.depth), 3 * ball / 60, 1e-9);
    EXPECT_NEAR(maps.volume, 3 * ball, 1e-9);
    EXPECT_EQ(maps.beyond, 0);
    EXPECT_NEAR(maps.top.at(1, 1), 4, 1e-9);
    EXPECT_NEAR(maps.speed.at(1, 1), 2, 1e-6);
    EXPECT_NEAR(maps.speed.at(3, 2), 2, 1e-6);
    EXPECT_EQ(maps.depth.at(0, 0), 0);
    EXPECT_EQ(maps.top.at(0, 0), 0);
    EXPECT_TRUE(std::isnan(maps.speed.at(0, 0)));
}

TEST(Maps, BeyondTheGridAndOverHoles) {
    ElevationGrid ground = level();
    ground.heights[static_cast<std::size_t>(1 * 5 + 1)] = NAN;
    Frame frame;
    add(frame, {20010, 100010, 101}, 1);   // over the hole
    add(frame, {19000, 100010, 101}, 1);   // outside
    add(frame, {20030, 100010, 101}, 1);
    const Maps maps = map(frame, ground, ground, 1);
    EXPECT_NEAR(maps.beyond, 2 * ball, 1e-9);
    EXPECT_NEAR(maps.volume, ball, 1e-9);
    EXPECT_TRUE(std::isnan(maps.depth.at(1, 1)));
    EXPECT_TRUE(std::isnan(maps.top.at(1, 1)));
}

TEST(Maps, TopOfABoulderCoversTheCellsBelowIt) {
    const ElevationGrid ground = level();
    Frame frame;
    add(frame, {20012, 100010, 115}, 15);
    const Maps maps = map(frame, ground, ground, 1);
    EXPECT_NEAR(maps.top.at(1, 1), 30, 1e-9);  // its highest point is in this cell
    EXPECT_NEAR(maps.top.at(2, 1), 15 + std::sqrt(225.0 - 64), 1e-9);
    EXPECT_NEAR(maps.top.at(4, 1), 0, 1e-9);
}

TEST(Maps, WrittenGridsReadBack) {
    const ElevationGrid ground = level();
    Frame frame;
    add(frame, {20010, 100010, 101}, 1, {3, 0, 0});
    const Maps maps = map(frame, ground, ground, 0.6);
    const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "grainray_deposit_speed.asc";
    surfaces::write_esri_grid(file, maps.speed);
    const ElevationGrid back = surfaces::read_grid_file(file, "");
    std::filesystem::remove(file);
    ASSERT_TRUE(back.same_nodes(ground));
    EXPECT_NEAR(back.at(1, 1), 3, 1e-6);
    EXPECT_TRUE(std::isnan(back.at(2, 2)));
}

TEST(Maps, CellsOfAnotherSize) {
    const ElevationGrid ground = level(), cells = cells_of_size(ground, 5);
    EXPECT_EQ(cells.columns, 9);
    EXPECT_EQ(cells.rows, 7);
    EXPECT_EQ(cells.at(8, 6), 100);
    Frame frame;
    add(frame, {20010, 100010, 101}, 1);
    EXPECT_NEAR(map(frame, ground, cells, 1).depth.at(2, 2), ball / 25, 1e-9);
    for (const double wrong : {0.0, -1.0, 1000.0, 1e-6, static_cast<double>(NAN)}) EXPECT_THROW(cells_of_size(ground, wrong), InputError) << wrong;
}

TEST(Maps, WrongInput) {
    Frame frame;
    add(frame, {20010, 100010, 101}, 1);
    for (const double wrong : {0.0, 1.1, -0.5}) EXPECT_THROW(map(frame, level(), level(), wrong), InputError) << wrong;
    frame.velocity.clear();
    EXPECT_THROW(map(frame, level(), level(), 0.6), InputError);
}

/// 200 grains in a row along (0.6, 0.8): from `first` to `first` + 199 m.
Frame row(double first, double height) {
    Frame frame;
    for (int k = 0; k < 200; ++k) add(frame, {500 + 0.6 * (first + k), 700 + 0.8 * (first + k), height}, 0.5f, {1, 0, 0});
    return frame;
}

TEST(Runout, OfARowThatSlid) {
    const Frame start = row(0, 90), now = row(300, 40);
    const Axis axis = flow_axis(start, now);
    EXPECT_NEAR(axis.dx, 0.6, 1e-9);
    EXPECT_NEAR(axis.dy, 0.8, 1e-9);
    EXPECT_NEAR(axis.along(500, 700), -1, 1e-9);  // two of 200 grains are the rearmost 1 %: the second is the zero
    const Runout r = runout(start, now, axis);
    EXPECT_NEAR(r.front, 300 + 197 - 1, 1e-9);
    EXPECT_NEAR(r.farthest, 300 + 199 - 1, 1e-9);
    EXPECT_NEAR(r.front_95, 300 + 189 - 1, 1e-9);
    EXPECT_NEAR(r.fall, 50, 1e-9);
    EXPECT_NEAR(r.reach_angle, std::atan(50.0 / 496) * 180 / std::numbers::pi, 1e-9);
    EXPECT_NEAR(r.x, 500 + 0.6 * 498, 1e-6);
    EXPECT_NEAR(r.centre_travel, 300, 1e-6);
    EXPECT_NEAR(r.centre_fall, 50, 1e-9);
    EXPECT_THROW(flow_axis(start, start), InputError);
    EXPECT_THROW(flow_axis(start, 0, 0), InputError);
    EXPECT_THROW(flow_axis(Frame{}, now), InputError);
}

TEST(Profile, AlongX) {
    const ElevationGrid ground = level();
    Frame frame;
    add(frame, {20010, 100010, 101}, 1, {4, 0, 0});
    add(frame, {20010, 100020, 101}, 1, {2, 0, 0});
    add(frame, {20010, 100020, 103}, 1, {2, 0, 0});
    add(frame, {20030, 100010, 101}, 1, {1, 0, 0});
    const auto rows = profile(map(frame, ground, ground, 0.5), ground, {20005, 100000, 1, 0}, 10);
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_NEAR(rows[0].distance, 5, 1e-9);
    EXPECT_NEAR(rows[0].depth, 1.5 * ball / 50, 1e-9);
    EXPECT_NEAR(rows[0].deepest, 2 * ball / 50, 1e-9);
    EXPECT_NEAR(rows[0].width, 20, 1e-9);
    EXPECT_NEAR(rows[0].speed, 8.0 / 3, 1e-6);
    EXPECT_NEAR(rows[0].ground, 100, 1e-9);
    EXPECT_EQ(rows[1].depth, 0);
    EXPECT_NEAR(rows[2].depth, ball / 50, 1e-9);
    EXPECT_THROW(profile(map(frame, ground, ground, 0.5), ground, {20005, 100000, 1, 0}, 0), InputError);
}

}  // namespace
}  // namespace grainray::deposit
