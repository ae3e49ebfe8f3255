// Meshes and terrain in pictures: what stands where, how it is lit, what is seen through it.
#include <array>
#include <gtest/gtest.h>
#include <numbers>

#include "pictures.hpp"

using namespace grainray;
using namespace grainray::test;

namespace {

/// A square of side 2 across the y axis at y = 0, of two triangles.
TriangleMesh square() { return {{{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}}, {{0, 1, 2}, {0, 2, 3}}}; }

Scene with_square(const Vec3d& translation = {}) {
    Scene scene;
    Mesh mesh;
    mesh.name = "square";
    mesh.geometry = square();
    mesh.translation = translation;
    scene.meshes = {mesh};
    return scene;
}

RenderSettings opaque() {
    RenderSettings settings = small();
    settings.mesh_opacity = 1;
    return settings;
}

Frame lone(const Vec3d& position, float radius) {
    Frame frame;
    add(frame, position, radius, 1);
    return frame;
}

Frame far_below() { return lone({0, 5, -100}, 0.01f); }

/// A plane of slope `gx` along x over 40 x 40 m about zero.
Scene with_ground(double gx, double hole_below = -1e9) {
    ElevationGrid grid{21, 21, -20, -20, 2, 2, {}};
    for (int j = 0; j < 21; ++j)
        for (int i = 0; i < 21; ++i) {
            const double x = -20 + 2 * i, y = -20 + 2 * j;
            grid.heights.push_back(std::hypot(x, y) < hole_below ? NAN : gx * x);
        }
    Scene scene;
    scene.terrain.emplace();
    scene.terrain->after = grid;
    return scene;
}

/// Almost straight down from 30 m, north up; 35 degrees over 48 rows show 18.9 m.
RenderSettings from_above() {
    RenderSettings settings = small();
    settings.camera.eye = Vec3d{0, -0.1, 30};
    settings.camera.target = Vec3d{};
    return settings;
}

bool grey(const Rgb& c) { return std::abs(c.r - c.g) < 25 && std::abs(c.g - c.b) < 25 && !c.white(); }
int brightness(const Rgb& c) { return c.r + c.g + c.b; }

}  // namespace

TEST(MeshPicture, FacetsCoverTheirPixelsFromBothSides) {
    RenderSettings settings = opaque();
    for (const double side : {-10.0, 10.0}) {
        settings.camera.eye = Vec3d{0, side, 0};
        const Image image = render(far_below(), with_square(), settings);
        // 10 m away a metre is 7.61 pixels: 24 +- 7.6 rows.
        for (const auto& [x, y] : {std::array{32, 24}, {26, 18}, {37, 18}, {26, 29}, {37, 29}}) EXPECT_TRUE(grey(pixel(image, x, y))) << side << ' ' << x << ' ' << y;
        for (const auto& [x, y] : {std::array{32, 14}, {32, 33}, {22, 24}, {42, 24}}) EXPECT_TRUE(pixel(image, x, y).white()) << side << ' ' << x << ' ' << y;
    }
}

TEST(MeshPicture, HidesWhatIsBehindAsMuchAsItIsOpaque) {
    const Frame frame = lone({0, 3, 0}, 0.8f);  // orange
    RenderSettings settings = opaque();
    const auto blueless = [&](double opacity) {
        settings.mesh_opacity = opacity;
        const Rgb c = centre(render(frame, with_square(), settings));
        return c.r - c.b;
    };
    const int bare = blueless(0), thin = blueless(0.2), thick = blueless(0.7), solid = blueless(1);
    EXPECT_GT(bare, 100);
    EXPECT_LT(thin, bare);
    EXPECT_LT(thick, thin);
    EXPECT_LT(solid, 20);
    EXPECT_GT(thin, 60);
}

TEST(MeshPicture, StandsWhereItsMotionBroughtItAtTheFramesTime) {
    Frame frame = far_below();
    frame.time = 2;
    RenderSettings settings = opaque();
    Scene moved = with_square(), standing = with_square({1.5, 0, 0});
    moved.meshes[0].motion.velocity = {0.75, 0, 0};
    const Image there = render(frame, standing, settings), here = render(frame, moved, settings);
    EXPECT_LT(difference(there, here), 0.01);
    EXPECT_TRUE(grey(pixel(here, 32 + 16, 24)));
    EXPECT_TRUE(pixel(here, 32 - 5, 24).white());
    frame.time = 0;
    EXPECT_GT(difference(render(frame, moved, settings), here), 5);

    // A quarter turn about the y axis through (1, 0, 0): the square about (0, 0, 0) comes to (1, 0, 1).
    Scene turning = with_square();
    turning.meshes[0].motion.rotation_axis = {0, 1, 0};
    turning.meshes[0].motion.rotation_point = {1, 0, 0};
    turning.meshes[0].motion.rotation_rate = std::numbers::pi / 4;
    frame.time = 2;
    EXPECT_LT(difference(render(frame, with_square({1, 0, 1}), settings), render(frame, turning, settings)), 0.3);
}

TEST(MeshPicture, TheCutHalfIsLeftOut) {
    Scene scene = with_square();
    RenderSettings settings = opaque();
    settings.mesh_cut = Vec3d{1, 0, 0};
    const Image image = render(far_below(), scene, settings);
    EXPECT_TRUE(grey(pixel(image, 28, 24)));
    EXPECT_TRUE(pixel(image, 36, 24).white());
    settings.mesh_cut = Vec3d{};
    EXPECT_NE(message([&] { render(far_below(), scene, settings); }).find("mesh_cut"), std::string::npos);
}

TEST(MeshPicture, IsShadedAndKeptInTheAutomaticView) {
    Scene scene = with_square();
    RenderSettings settings = opaque();
    settings.camera = {};
    const Image image = render(lone({0, 0.5, -1.5}, 0.2f), scene, settings);
    EXPECT_GT(filled(image), 0.15);
    for (int x = 0; x < 64; ++x) EXPECT_TRUE(pixel(image, x, 0).white() && pixel(image, x, 47).white());
}

TEST(TerrainPicture, CoversTheGroundAndStaysOutOfHoles) {
    const Frame frame = lone({0, 0, 0.5}, 0.5f);
    const Image bare = render(frame, {}, from_above()), ground = render(frame, with_ground(0), from_above());
    EXPECT_TRUE(pixel(bare, 50, 24).white());
    EXPECT_FALSE(pixel(ground, 34, 30).white());
    const Rgb before = centre(bare), after = centre(ground);
    EXPECT_GT(before.r - before.b, 50);  // the sphere is seen in both
    EXPECT_GT(after.r - after.b, 50);
    const Image hole = render(frame, with_ground(0, 5), from_above());
    EXPECT_TRUE(pixel(hole, 32 + 6, 24).white());    // 2.4 m from the middle
    EXPECT_FALSE(pixel(hole, 32 + 18, 24).white());  // 7.1 m
}

TEST(TerrainPicture, SlopesThatFaceTheLampAreBrighter) {
    // From above with north up the lamp stands in the west (left): ground that falls to the west faces it.
    const Frame frame = lone({0, 0, 0.5}, 0.1f);
    const auto shade = [&](double gx) { return brightness(pixel(render(frame, with_ground(gx), from_above()), 32, 30)); };
    EXPECT_GT(shade(0.5), shade(-0.5) + 60);
    EXPECT_GT(shade(0.25), shade(-0.25) + 30);
}

TEST(TerrainPicture, AutomaticCameraStandsOnTheLowerSide) {
    // Blue spheres low on the slope, orange ones high: from the lower side blue is nearer, hence lower in the picture.
    Frame frame;
    for (int k = -2; k <= 2; ++k) {
        add(frame, {-6, 3.0 * k, -1.5}, 1.5f, 0);
        add(frame, {6, 3.0 * k, 4.5}, 1.5f, 1);
    }
    RenderSettings settings = small();
    settings.width = 128, settings.height = 96;
    settings.camera = {};
    const Image image = render(frame, with_ground(0.5), settings);
    double blue = 0, blue_row = 0, orange = 0, orange_row = 0;
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 128; ++x) {
            const Rgb c = pixel(image, x, y);
            if (c.b > c.r + 40) ++blue, blue_row += y;
            if (c.r > c.b + 60) ++orange, orange_row += y;
        }
    ASSERT_GT(blue, 50);
    ASSERT_GT(orange, 50);
    EXPECT_GT(blue_row / blue, orange_row / orange + 10);
}

TEST(TerrainPicture, DepthIsMeasuredFromTheGround) {
    Scene scene = with_ground(0);
    for (double& h : scene.terrain->after->heights) h += 100;
    Frame frame;
    add(frame, {0, 0, 102}, 1);  // its top is 3 m above the ground
    RenderSettings settings = from_above();
    settings.camera.eye = Vec3d{0, -0.1, 110};
    settings.camera.target = Vec3d{0, 0, 100};
    settings.color_by = "depth";
    settings.color_minimum = 0, settings.color_maximum = 3;
    const Rgb at_end = centre(render(frame, scene, settings));
    EXPECT_TRUE(at_end.r > 180 && at_end.g > 180 && at_end.b < 100);
    settings.color_minimum = 3, settings.color_maximum = 6;
    const Rgb at_start = centre(render(frame, scene, settings));
    EXPECT_TRUE(at_start.b > at_start.g + 30 && at_start.b < 160);
    EXPECT_NE(message([&] { render(frame, {}, settings); }).find("neither terrain nor a plane"), std::string::npos);
    Scene floor;
    floor.planes = {plane({0, 0, 100}, {0, 0, 1})};
    settings.color_minimum = 0, settings.color_maximum = 3;
    const Rgb over_plane = centre(render(frame, floor, settings));
    EXPECT_TRUE(over_plane.r > 180 && over_plane.g > 180 && over_plane.b < 100);
}

TEST(TerrainPicture, WhatCannotBeReadIsNamed) {
    Scene scene;
    scene.terrain.emplace();
    scene.terrain->after_file = "/nowhere/after.asc";
    EXPECT_NE(message([&] { render(block(2), scene, small()); }).find("/nowhere/after.asc"), std::string::npos);
}

TEST(SharedPictures, KeepCameraAndColours) {
    Frame early = block(3), late = block(3);
    for (std::size_t i = 0; i < late.size(); ++i) late.position[i].x += 2, late.velocity[i] = {9, 0, 0};
    late.time = 1;
    RenderSettings settings = small("speed");
    settings.camera = {};
    Renderer alone({}, settings), together({}, settings);
    together.include(early);
    together.include(late);
    ASSERT_TRUE(together.shared_colors());
    EXPECT_EQ(together.shared_colors()->low, 0);
    EXPECT_NEAR(together.shared_colors()->high, 9, 1.01);
    const Image both = together.draw(early), own = alone.draw(early);
    EXPECT_LT(filled(both), 0.7 * filled(own));  // room for the late ones
    // What moved by 2 m moved in the picture too: the early picture has nothing where the late one is.
    const Image second = together.draw(late);
    int overlap = 0, first_count = 0;
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) {
            const bool a = !pixel(both, x, y).white(), b = !pixel(second, x, y).white();
            overlap += a && b, first_count += a;
        }
    EXPECT_GT(first_count, 50);
    EXPECT_LT(overlap, first_count / 4);
}

TEST(SharedPictures, SheetShowsSnapshotsInOrder) {
    RenderSettings settings;
    settings.width = 640, settings.height = 360;
    settings.color_by = "material";
    std::vector<Frame> frames;
    for (int k = 0; k < 6; ++k) {
        Frame frame;
        for (int i = 0; i <= k; ++i) add(frame, {0.4 * i, 0, 0.1}, 0.2f, 1);
        frame.time = k;
        frames.push_back(frame);
    }
    Renderer renderer({}, settings);
    for (const Frame& frame : frames) renderer.include(frame);
    const Image page = renderer.sheet(6, [&](std::size_t k) { return frames[k]; });
    ASSERT_EQ(page.width, 640);
    ASSERT_EQ(page.height, 360);
    // Three columns of 187 pixels and two rows of 180: one sphere more in each.
    std::array<int, 6> colored{};
    for (int y = 0; y < 360; ++y)
        for (int x = 0; x < 561; ++x) {
            const Rgb c = pixel(page, x, y);
            const int most = std::max({c.r, c.g, c.b}), least = std::min({c.r, c.g, c.b});
            colored[static_cast<std::size_t>(y / 180 * 3 + x / 187)] += most - least > 60;
        }
    for (std::size_t k = 1; k < 6; ++k) EXPECT_GT(colored[k], colored[k - 1] + 20) << k;
    EXPECT_GT(colored[0], 20);
}
