// What must be seen in a picture, and where.
#include <functional>
#include <gtest/gtest.h>
#include <numbers>
#include <tbb/global_control.h>

#include "pictures.hpp"

using namespace grainray;
using namespace grainray::test;

namespace {

// Colours of the first materials: 0 blue, 1 orange, 2 green.
bool blue(const Rgb& c) { return c.b > c.g + 20 && c.g > c.r; }
bool orange(const Rgb& c) { return c.r > c.g + 20 && c.g > c.b + 20; }
bool yellow(const Rgb& c) { return c.r > 180 && c.g > 180 && c.b < 100; }
bool violet(const Rgb& c) { return c.b > c.g + 30 && c.r > c.g + 10 && c.b < 160; }

}  // namespace

TEST(Picture, SphereInTheMiddleBackgroundAround) {
    Frame frame;
    add(frame, {0, 0, 0}, 1, 1);
    const Image image = render(frame, {}, small());
    ASSERT_EQ(image.rgb.size(), 3u * 64 * 48);
    EXPECT_TRUE(orange(centre(image)));
    for (const auto& [x, y] : {std::pair{0, 0}, {63, 0}, {0, 47}, {63, 47}}) EXPECT_TRUE(pixel(image, x, y).white());
    // 10 m away, 35 degrees over 48 rows: a disc of radius 7.65 pixels.
    EXPECT_NEAR(filled(image) * 64 * 48, std::numbers::pi * 7.65 * 7.65, 45);
}

TEST(Picture, TheNearerSphereHidesTheOther) {
    Frame frame;
    add(frame, {0, 2, 0}, 1, 1);
    add(frame, {0, -2, 0}, 1, 0);
    EXPECT_TRUE(blue(centre(render(frame, {}, small()))));
    RenderSettings behind = small();
    behind.camera.eye = Vec3d{0, 10, 0};
    EXPECT_TRUE(orange(centre(render(frame, {}, behind))));
}

TEST(Picture, IsTheSameTwiceAndWithOneThread) {
    const Frame frame = block(8);
    Scene scene;
    scene.planes = {plane({}, {0, 0, 1}), plane({-0.1, 0, 0}, {1, 0, 0})};
    RenderSettings settings;
    settings.width = 320, settings.height = 200;
    const Image first = render(frame, scene, settings);
    EXPECT_EQ(first.rgb, render(frame, scene, settings).rgb);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(first.rgb, render(frame, scene, settings).rgb);
}

TEST(Picture, DoesNotDependOnWhereTheWorldIs) {
    Frame frame = block(6);
    Scene scene;
    scene.planes = {plane({}, {0, 0, 1})};
    RenderSettings automatic = small("speed"), given = automatic;
    automatic.camera = {};
    given.camera.eye = Vec3d{2, -6, 3};
    given.camera.target = Vec3d{0.5, 0.5, 0.5};
    const Image near_automatic = render(frame, scene, automatic), near_given = render(frame, scene, given);

    const Vec3d shift{1e4, 2e5, 3e3};
    for (Vec3d& p : frame.position) p += shift;
    scene.planes[0].point += shift;
    *given.camera.eye += shift;
    *given.camera.target += shift;
    EXPECT_LT(difference(near_automatic, render(frame, scene, automatic)), 0.5);
    EXPECT_LT(difference(near_given, render(frame, scene, given)), 0.5);
}

TEST(Picture, AutomaticCameraShowsEverythingAndForgetsRunaways) {
    Frame frame = block(10);
    RenderSettings settings = small("speed");
    settings.camera = {};
    const Image whole = render(frame, {}, settings);
    EXPECT_GT(filled(whole), 0.25);
    for (int x = 0; x < 64; ++x) EXPECT_TRUE(pixel(whole, x, 0).white() && pixel(whole, x, 47).white());
    add(frame, {1e4, 0, 0}, 0.1f);
    EXPECT_NEAR(filled(render(frame, {}, settings)), filled(whole), 0.05);
}

TEST(Picture, WallsBehindAreSeenWallsInFrontAreNot) {
    Frame frame;
    add(frame, {0, 0, 0}, 1, 1);
    const double bare = filled(render(frame, {}, small()));
    Scene front, back;
    front.planes = {plane({0, -1, 0}, {0, 1, 0})};
    back.planes = {plane({0, 1, 0}, {0, -1, 0})};
    const Image through = render(frame, front, small()), before = render(frame, back, small());
    EXPECT_TRUE(orange(centre(through)));
    EXPECT_TRUE(orange(centre(before)));
    EXPECT_TRUE(pixel(through, 32 + 12, 24 + 12).white());  // beside the sphere, within the wall's outline
    EXPECT_FALSE(pixel(before, 32 + 12, 24 + 12).white());
    EXPECT_GT(filled(through), bare);
}

TEST(Picture, PlanesStandWhereTheyAreAtTheFramesTime) {
    Frame frame;
    add(frame, {0, 0, 0}, 1, 1);
    frame.time = 2;
    Scene moving, standing;
    moving.planes = {plane({0, 0, -5}, {0, 0, 1})};
    moving.planes[0].motion.velocity = {0, 0, 2};
    standing.planes = {plane({0, 0, -1}, {0, 0, 1})};
    RenderSettings settings = small();
    settings.camera.eye = Vec3d{0, -10, 3};
    EXPECT_LT(difference(render(frame, moving, settings), render(frame, standing, settings)), 0.01);
}

TEST(Picture, AnEmptyDrumIsWholeAndRound) {
    Scene scene;
    for (int i = 0; i < 24; ++i) {
        const double a = 2 * std::numbers::pi * i / 24;
        scene.planes.push_back(plane({std::sin(a), 0, std::cos(a)}, {-std::sin(a), 0, -std::cos(a)}));
    }
    scene.planes.push_back(plane({0, 0.5, 0}, {0, -1, 0}));
    scene.planes.push_back(plane({0, -0.5, 0}, {0, 1, 0}));
    Frame frame;
    add(frame, {0, 0, -0.6}, 0.4f, 1);
    RenderSettings settings = small();
    settings.camera.eye = Vec3d{0, -4, 0};
    const Image image = render(frame, scene, settings);
    EXPECT_TRUE(pixel(image, 0, 24).white());
    // Radius 1 m, front face 3.5 m away: 21.75 pixels; a drum of 24 sides fills nearly that disc.
    EXPECT_NEAR(filled(image) * 64 * 48, std::numbers::pi * 21.75 * 21.75, 130);
}

TEST(Picture, ColourBarAndItsEnds) {
    RenderSettings settings;
    settings.width = 480, settings.height = 270;
    const Image image = render(block(6), {}, settings);
    int bright = 0, dark = 0;
    for (int y = 0; y < 270; ++y)
        for (int x = 420; x < 480; ++x) bright += yellow(pixel(image, x, y)), dark += violet(pixel(image, x, y));
    EXPECT_GT(bright, 20);
    EXPECT_GT(dark, 20);
}

TEST(Picture, GivenRangeSetsTheColours) {
    Frame frame;
    add(frame, {0, 0, 0}, 1, 0, {3, 0, 0});
    RenderSettings settings = small("speed");
    settings.color_minimum = 0, settings.color_maximum = 3;
    EXPECT_TRUE(yellow(centre(render(frame, {}, settings))));
    settings.color_minimum = 3, settings.color_maximum = 6;
    EXPECT_TRUE(violet(centre(render(frame, {}, settings))));
    settings.color_minimum = 6, settings.color_maximum = 6;
    EXPECT_THROW(render(frame, {}, settings), InputError);
}

TEST(Picture, NoParticleAndOneParticle) {
    Scene scene;
    scene.planes = {plane({}, {0, 0, 1})};
    RenderSettings settings;
    settings.width = 320, settings.height = 200;
    EXPECT_GT(filled(render({}, scene, settings)), 0.01);
    EXPECT_GT(filled(render({}, {}, settings)), 0.001);  // the caption
    Frame frame;
    add(frame, {5, 5, 5}, 0.01f);
    EXPECT_GT(filled(render(frame, scene, settings)), 0.1);
}

TEST(Picture, EveryFieldGivesColours) {
    for (const char* field : {"speed", "radius", "velocity", "angular_velocity", "id", "material", "coordination", "contact_force", "mass"})
        EXPECT_GT(filled(render(block(2), {}, small(field))), 0.0) << field;
}

TEST(Picture, LeavesOutWhatIsNotFinite) {
    Frame frame;
    add(frame, {0, 0, 0}, 1, 1);
    add(frame, {std::nan(""), 0, 0}, 1, 0, {std::nanf(""), 0, 0});
    EXPECT_TRUE(orange(centre(render(frame, {}, small()))));
    frame.position[1] = {0, -2, 0};
    EXPECT_FALSE(centre(render(frame, {}, small("speed"))).white());
}

TEST(Picture, WrongInputIsNamed) {
    const Frame frame = block(2);
    EXPECT_NE(message([&] { render(frame, {}, small("sped")); }).find("speed, depth, radius"), std::string::npos);
    Frame lacking = frame;
    lacking.velocity.clear();
    EXPECT_NE(message([&] { render(lacking, {}, small("speed")); }).find("\"velocity\""), std::string::npos);
    lacking.radius.clear();
    EXPECT_NE(message([&] { render(lacking, {}, small()); }).find("radii"), std::string::npos);
    for (const std::int64_t size : {15, 0, -1, 16385}) {
        RenderSettings settings = small();
        settings.width = size;
        EXPECT_NE(message([&] { render(frame, {}, settings); }).find("render.width"), std::string::npos);
        std::swap(settings.width, settings.height);
        EXPECT_THROW(render(frame, {}, settings), InputError);
    }
    RenderSettings settings = small();
    settings.camera.target = settings.camera.eye;
    EXPECT_NE(message([&] { render(frame, {}, settings); }).find("render.camera.eye"), std::string::npos);
}
