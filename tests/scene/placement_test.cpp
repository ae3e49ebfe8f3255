// place_particles(): lattices, lists, files, size distributions, the domain.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "scene_text.hpp"

namespace grainray::test {
namespace {

const std::string column = with_grain + R"([particles.column]
type = "lattice"
material = "grain"
radius = 0.1
count = [3, 4, 5]
spacing = [0.24, 0.25, 0.26]
origin = [0.12, 0, 1]
jitter = [0.01, 0.02, 0]
velocity = [1, 2, 3]
)";

TEST(Lattice, JitterShiftsWithinItsBoundsAndOnlyAlongItsAxes) {
    const InitialState s = place_particles(parse(column));
    ASSERT_EQ(s.size(), 60u);
    double largest = 0;
    for (std::size_t n = 0; n < s.size(); ++n) {
        const Vec3d x = s.positions[n];
        const double dx = x.x - (0.12 + 0.24 * double(n % 3)), dy = x.y - 0.25 * double(n / 3 % 4);
        EXPECT_TRUE(dx > -1e-12 && dx < 0.01 + 1e-12 && dy > -1e-12 && dy < 0.02 + 1e-12) << n;
        EXPECT_DOUBLE_EQ(x.z, 1 + 0.26 * double(n / 12));
        largest = std::max(largest, dy);
    }
    EXPECT_GT(largest, 0.015);
    EXPECT_EQ(s.velocities.back(), (Vec3d{1, 2, 3}));
    EXPECT_EQ(s.radii.back(), 0.1);
    EXPECT_EQ(s.materials.back(), 0u);
}

TEST(Lattice, RepeatsForASeedAndDiffersForAnother) {
    const auto once = place_particles(parse(column)), again = place_particles(parse(column)),
               other = place_particles(parse(column, {"simulation.seed=2"}));
    EXPECT_EQ(once.positions, again.positions);
    EXPECT_NE(once.positions[0], other.positions[0]);
}

/// The numbers themselves (from a separate program): a change here changes every run.
TEST(Lattice, JitterIsPinned) {
    const InitialState s = place_particles(parse(column));
    EXPECT_DOUBLE_EQ(s.positions[0].x, 0.12687896779183372);
    EXPECT_DOUBLE_EQ(s.positions[59].y, 0.7629828405122001);
}

TEST(Lattice, DoesNotDependOnOtherGroups) {
    const std::string before =
        "[particles.first]\ntype = \"list\"\nmaterial = \"grain\"\npositions = [[9, 9, 9]]\nradii = 1\n";
    std::string text = column;
    text.insert(text.find("[particles"), before);
    const auto alone = place_particles(parse(column)), second = place_particles(parse(text));
    ASSERT_EQ(second.size(), 61u);
    EXPECT_TRUE(std::equal(alone.positions.begin(), alone.positions.end(), second.positions.begin() + 1));
}

TEST(Lattice, MayBeEmpty) {
    EXPECT_EQ(place_particles(parse(column, {"particles.column.count=[3, 0, 5]"})).size(), 0u);
}

TEST(Lattice, PlacesTheLargePublishedColumn) {
    const auto s = place_particles(parse(column, {"particles.column.count=[71, 160, 141]"}));
    EXPECT_EQ(s.size(), 1601760u);
}

TEST(List, ValuesPerParticle) {
    const auto s = place_particles(parse(with_grain + R"([particles.l]
type = "list"
material = "grain"
positions = [[0, 0, 0], [1, 0, 0]]
radii = [0.1, 0.2]
velocities = [[1, 0, 0], [0, 1, 0]]
angular_velocity = [0, 0, 5]
)"));
    EXPECT_EQ(s.radii, (std::vector{0.1, 0.2}));
    EXPECT_EQ(s.velocities[1], (Vec3d{0, 1, 0}));
    EXPECT_EQ(s.angular_velocities[1], (Vec3d{0, 0, 5}));
}

/// Mean and deviation of 50,000 radii of a lattice.
std::pair<double, double> moments(const std::string& size) {
    const auto s = place_particles(parse(with_grain + R"([particles.l]
type = "lattice"
material = "grain"
count = [50, 50, 20]
spacing = [1, 1, 1]
origin = [0, 0, 0]
)" + size));
    const double n = static_cast<double>(s.size()), mean = std::accumulate(s.radii.begin(), s.radii.end(), 0.0) / n;
    double square = 0;
    for (const double r : s.radii) square += (r - mean) * (r - mean);
    return {mean, std::sqrt(square / n)};
}

TEST(Sizes, MeanAndDeviationAreThoseAskedFor) {
    const auto [uniform, uniform_deviation] = moments("size = \"uniform\"\nradius_minimum = 1\nradius_maximum = 3\n");
    EXPECT_NEAR(uniform, 2, 0.01);
    EXPECT_NEAR(uniform_deviation, 1 / std::sqrt(3.0), 0.01);
    const auto [normal, normal_deviation] = moments(
        "size = \"normal\"\nradius_mean = 2\nradius_deviation = 0.3\nradius_minimum = 0.1\nradius_maximum = 4\n");
    EXPECT_NEAR(normal, 2, 0.006);
    EXPECT_NEAR(normal_deviation, 0.3, 0.006);
    const auto [lognormal, lognormal_deviation] = moments(
        "size = \"lognormal\"\nradius_mean = 2\nradius_deviation = 0.6\nradius_minimum = 0.01\nradius_maximum = 90\n");
    EXPECT_NEAR(lognormal, 2, 0.015);
    EXPECT_NEAR(lognormal_deviation, 0.6, 0.02);
    const auto [table, table_deviation] = moments("size = \"table\"\nradii = [1, 5]\nweights = [3, 1]\n");
    EXPECT_NEAR(table, 2, 0.03);
    EXPECT_NEAR(table_deviation, std::sqrt(3.0), 0.03);
}

TEST(Sizes, DefaultCutOffsAreThreeDeviations) {
    const std::string text = with_grain + R"([particles.l]
type = "lattice"
material = "grain"
count = [20, 20, 20]
spacing = [1, 1, 1]
origin = [0, 0, 0]
size = "lognormal"
radius_mean = 2
radius_deviation = 1
)";
    const Scene scene = parse(text);
    const double spread = std::sqrt(std::log(1.25)), median = 2 / std::sqrt(1.25);
    EXPECT_NEAR(scene.particles[0].size.minimum, median * std::exp(-3 * spread), 1e-12);
    EXPECT_NEAR(scene.particles[0].size.maximum, median * std::exp(3 * spread), 1e-12);
    for (const double r : place_particles(scene).radii)
        ASSERT_TRUE(r >= scene.particles[0].size.minimum && r <= scene.particles[0].size.maximum);
}

class CsvFile : public testing::Test {
protected:
    void SetUp() override { std::filesystem::create_directories(folder_); }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    Scene scene(const std::string& csv) {
        std::ofstream(folder_ / "p.csv") << csv;
        std::ofstream(folder_ / "s.toml")
            << with_grain +
                   "[particles.f]\ntype = \"file\"\nmaterial = \"grain\"\npath = \"p.csv\"\nvelocity = [7, 0, 0]\n";
        return load_scene(folder_ / "s.toml");
    }
    std::string error(const std::string& csv) { return placement_error(scene(csv)); }

    const std::filesystem::path folder_ =
        std::filesystem::path(testing::TempDir()) /
        ("grainray_csv_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(CsvFile, ReadsColumnsByName) {
    const auto s =
        place_particles(scene("# made by hand\nid, radius, z, y, x\r\n1, 0.5, 3, 2, 1\r\n\n2,0.25,6,5,-4e0\n"));
    ASSERT_EQ(s.size(), 2u);
    EXPECT_EQ(s.positions[0], (Vec3d{1, 2, 3}));
    EXPECT_EQ(s.positions[1], (Vec3d{-4, 5, 6}));
    EXPECT_EQ(s.radii[1], 0.25);
    EXPECT_EQ(s.velocities[1], (Vec3d{7, 0, 0}));
}

TEST_F(CsvFile, VelocitiesReplaceThoseOfTheGroup) {
    const auto s = place_particles(scene("x,y,z,radius,vx,vy,vz,wx,wy,wz\n0,0,0,1,1,2,3,4,5,6\n"));
    EXPECT_EQ(s.velocities[0], (Vec3d{1, 2, 3}));
    EXPECT_EQ(s.angular_velocities[0], (Vec3d{4, 5, 6}));
}

TEST_F(CsvFile, ErrorsCarryTheLine) {
    EXPECT_NE(error("x,y,z\n").find("p.csv:1: the header has no column 'radius'"), std::string::npos)
        << error("x,y,z\n");
    EXPECT_NE(error("x,y,z,raduis\n").find("did you mean 'raduis'?"), std::string::npos) << error("x,y,z,raduis\n");
    EXPECT_NE(error("x,y,z,radius\n0,0,0,1\n0,nan,0,1\n").find("p.csv:3: column 'y': nan is not a finite number"),
              std::string::npos);
    EXPECT_NE(error("x,y,z,radius\n\n0,0,0\n").find("p.csv:3: has 3 values, the header has 4 columns"),
              std::string::npos);
    EXPECT_NE(error("x,y,z,radius\n0,0,zero,1\n").find("p.csv:2: column 'z': 'zero' is not a number"),
              std::string::npos);
    EXPECT_NE(error("x,y,z,radius\n0,0,0,-1\n").find("p.csv:2: column 'radius': -1 must be greater than 0"),
              std::string::npos);
    EXPECT_NE(error("x,y,z,radius,vx\n0,0,0,1,1\n").find("no column 'vy'"), std::string::npos);
    EXPECT_NE(error("").find("p.csv:1: is empty"), std::string::npos);
}

TEST_F(CsvFile, MissingFileIsNamed) {
    Scene s = scene("x,y,z,radius\n");
    std::filesystem::remove(folder_ / "p.csv");
    EXPECT_NE(placement_error(s).find("key 'particles.f.path'"), std::string::npos) << placement_error(s);
}

TEST(DomainOfPlacement, PeriodicAxesWrapAndOthersRefuse) {
    const std::string text = with_grain + R"([particles.l]
type = "list"
material = "grain"
positions = [[-0.25, 0.5, 0.5], [1, 0.5, 0.5], [3.5, 0.5, 0.5]]
radii = 0.1
[domain]
lower = [0, 0, 0]
upper = [1, 1, 1]
periodic = [true, false, false]
)";
    const auto s = place_particles(parse(text));
    EXPECT_EQ(s.positions[0].x, 0.75);
    EXPECT_EQ(s.positions[1].x, 0);
    EXPECT_EQ(s.positions[2].x, 0.5);
    const std::string error = placement_error(parse(text, {"domain.periodic=[false, true, false]"}));
    EXPECT_NE(error.find("test.toml: key 'particles.l': particle 0 of the group is outside the domain (x = -0.25 m"),
              std::string::npos)
        << error;
}

}  // namespace
}  // namespace grainray::test
