// Random fill: no overlap, inside the box, periodic, repeatable, loud when it cannot be done.
#include <algorithm>
#include <chrono>
#include <numbers>

#include "scene_text.hpp"

namespace grainray::test {
namespace {

std::string fill(const std::string& lines) {
    return with_grain +
           "[particles.f]\ntype = \"fill\"\nmaterial = \"grain\"\nlower = [-1, 0, 2]\nupper = [1, 1, 3]\n" + lines;
}
const std::string periodic = "[domain]\nlower = [-1, 0, 2]\nupper = [1, 1, 3]\nperiodic = [true, true, false]\n";

double solid_volume(const InitialState& s) {
    double sum = 0;
    for (const double r : s.radii) sum += 4.0 / 3.0 * std::numbers::pi * r * r * r;
    return sum;
}

void expect_inside(const InitialState& s, const Box& box, std::array<bool, 3> periodic_axes = {}) {
    for (std::size_t i = 0; i < s.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) {
            const double inset = periodic_axes[static_cast<std::size_t>(axis)] ? 0 : s.radii[i],
                         x = s.positions[i][axis];
            EXPECT_TRUE(x >= box.lower[axis] + inset - 1e-12 && x <= box.upper[axis] - inset + 1e-12) << i;
        }
}

const Box box{{-1, 0, 2}, {1, 1, 3}};

TEST(Fill, CountOfEqualSpheres) {
    const auto s = place_particles(parse(fill("radius = 0.05\ncount = 900\n")));
    ASSERT_EQ(s.size(), 900u);
    EXPECT_GE(smallest_gap(s), 0);
    expect_inside(s, box);
}

TEST(Fill, SolidFractionOfMixedSizes) {
    const auto s = place_particles(
        parse(fill("solid_fraction = 0.33\nsize = \"table\"\nradii = [0.02, 0.16]\nweights = [300, 1]\n")));
    EXPECT_NEAR(solid_volume(s) / 2, 0.33, 0.01);
    EXPECT_GT(s.size(), 1000u);
    EXPECT_EQ(*std::max_element(s.radii.begin(), s.radii.end()), 0.16);
    EXPECT_GE(smallest_gap(s), 0);
    expect_inside(s, box);
}

TEST(Fill, LogNormalStaysWithinItsCutOffs) {
    const auto s =
        place_particles(parse(fill("count = 1500\nsize = \"lognormal\"\nradius_mean = 0.03\nradius_deviation = "
                                   "0.015\nradius_minimum = 0.01\nradius_maximum = 0.08\n")));
    const auto [smallest, largest] = std::minmax_element(s.radii.begin(), s.radii.end());
    EXPECT_GE(*smallest, 0.01);
    EXPECT_LE(*largest, 0.08);
    EXPECT_GE(smallest_gap(s), 0);
}

TEST(Fill, PeriodicAxesAreFilledToTheirEnds) {
    const auto s = place_particles(parse(fill("radius = 0.05\ncount = 900\n") + periodic));
    EXPECT_GE(smallest_gap(s, &box, {true, true, false}), 0);
    expect_inside(s, box, {true, true, false});
    EXPECT_TRUE(std::any_of(s.positions.begin(), s.positions.end(), [](const Vec3d& x) { return x.x < -0.99; }));
}

TEST(Fill, ABoxNarrowerThanThePeriodHoldsWholeSpheres) {
    const auto s =
        place_particles(parse(fill("radius = 0.05\ncount = 300\n") + periodic, {"particles.f.upper=[0,1,3]"}));
    expect_inside(s, {{-1, 0, 2}, {0, 1, 3}}, {false, true, false});
    EXPECT_GE(smallest_gap(s, &box, {true, true, false}), 0);
}

TEST(Fill, RepeatsForASeed) {
    const std::string text = fill("radius = 0.05\ncount = 200\n");
    EXPECT_EQ(place_particles(parse(text)).positions, place_particles(parse(text)).positions);
    EXPECT_NE(place_particles(parse(text)).positions, place_particles(parse(text, {"simulation.seed=9"})).positions);
}

TEST(Fill, NothingWantedNothingPlaced) {
    EXPECT_EQ(place_particles(parse(fill("radius = 0.05\ncount = 0\n"))).size(), 0u);
}

TEST(Fill, GivesUpLoudly) {
    const std::string dense = placement_error(parse(fill("radius = 0.1\nsolid_fraction = 0.6\n")));
    EXPECT_TRUE(dense.starts_with("test.toml: key 'particles.f': random insertion placed ")) << dense;
    EXPECT_NE(dense.find(" of 0.60"), std::string::npos) << dense;
    EXPECT_NE(dense.find("lower solid_fraction, enlarge the box"), std::string::npos) << dense;
    const std::string large = placement_error(parse(fill("radius = 0.6\ncount = 1\n")));
    EXPECT_NE(large.find("radius 0.6 m does not fit into the box of 2 x 1 x 1 m"), std::string::npos) << large;
    const std::string tail =
        placement_error(parse(fill("count = 9\nsize = \"normal\"\nradius_mean = 0.1\nradius_deviation = "
                                   "0.001\nradius_minimum = 0.2\nradius_maximum = 0.3\n")));
    EXPECT_NE(tail.find("move the cut-offs towards the mean"), std::string::npos) << tail;
}

TEST(Fill, TwentyThousandTakeAboutASecond) {
    const auto begin = std::chrono::steady_clock::now();
    const auto s = place_particles(parse(fill("radius = 0.0185\ncount = 20000\n")));  // solid fraction 0.27
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    EXPECT_EQ(s.size(), 20000u);
    EXPECT_LT(taken.count(), 20) << "generous: sanitizers and busy machines";
    RecordProperty("seconds", std::to_string(taken.count()));
}

}  // namespace
}  // namespace grainray::test
