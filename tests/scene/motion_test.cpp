// plane_at() against closed forms and against differences of itself.
#include <numbers>

#include "scene_text.hpp"

namespace grainray::test {
namespace {

constexpr double pi = std::numbers::pi;

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], tolerance) << "axis " << axis;
}

Plane moving() {
    Plane plane{"p", "m", {1, 2, 3}, {1, 0, 0}, {}};
    plane.motion.start = 1;
    plane.motion.stop = 3;
    return plane;
}

TEST(PlaneMotion, StillPlaneStaysWhereItIs) {
    const Plane plane{"p", "m", {1, 2, 3}, {0, 1, 0}, {}};
    const PlaneState s = plane_at(plane, 17);
    EXPECT_EQ(s.point, plane.point);
    EXPECT_EQ(s.normal, plane.normal);
    EXPECT_EQ(s.velocity, Vec3d{});
    EXPECT_EQ(s.angular_velocity, Vec3d{});
}

TEST(PlaneMotion, TranslationBetweenStartAndStop) {
    Plane plane = moving();
    plane.motion.velocity = {0.5, 0, -1};
    EXPECT_EQ(plane_at(plane, 0.5).point, plane.point);
    EXPECT_EQ(plane_at(plane, 0.5).velocity, Vec3d{});
    expect_near(plane_at(plane, 2).point, {1.5, 2, 2}, 1e-15);
    EXPECT_EQ(plane_at(plane, 2).velocity, plane.motion.velocity);
    EXPECT_EQ(plane_at(plane, 1).velocity, plane.motion.velocity);
    expect_near(plane_at(plane, 9).point, {2, 2, 1}, 1e-15);
    EXPECT_EQ(plane_at(plane, 3).velocity, Vec3d{});
}

TEST(PlaneMotion, RotationTurnsPointAndNormal) {
    Plane plane = moving();
    plane.motion.rotation_axis = {0, 0, 1};
    plane.motion.rotation_point = {1, 0, 0};
    plane.motion.rotation_rate = pi / 2;  // a quarter turn a second
    const PlaneState s = plane_at(plane, 2);
    expect_near(s.point, {-1, 0, 3}, 1e-15);
    expect_near(s.normal, {0, 1, 0}, 1e-15);
    EXPECT_EQ(s.centre, plane.motion.rotation_point);
    expect_near(s.angular_velocity, {0, 0, pi / 2}, 1e-15);
    const PlaneState stopped = plane_at(plane, 100);
    expect_near(stopped.point, {1, -2, 3}, 1e-14);
    expect_near(stopped.normal, {-1, 0, 0}, 1e-15);
    EXPECT_EQ(stopped.angular_velocity, Vec3d{});
}

TEST(PlaneMotion, OscillationStartsWhereThePlaneIs) {
    Plane plane = moving();
    plane.motion.oscillation_amplitude = {0, 0, 0.1};
    plane.motion.oscillation_frequency = 2;
    plane.motion.oscillation_phase = 0.3;
    EXPECT_EQ(plane_at(plane, 1).point, plane.point);
    const double t = 1.37, phase = 4 * pi * (t - 1) + 0.3;
    expect_near(plane_at(plane, t).point, {1, 2, 3 + 0.1 * (std::sin(phase) - std::sin(0.3))}, 1e-14);
    expect_near(plane_at(plane, t).velocity, {0, 0, 0.1 * 4 * pi * std::cos(phase)}, 1e-13);
    expect_near(plane_at(plane, 3).point, plane.point, 1e-14);  // four whole periods
}

TEST(PlaneMotion, VelocityIsTheRateOfChangeOfEveryPoint) {
    Plane plane = moving();
    plane.motion.stop = std::numeric_limits<double>::infinity();
    plane.motion.velocity = {0.2, -0.1, 0.3};
    plane.motion.rotation_axis = {0.6, 0, 0.8};
    plane.motion.rotation_point = {0, 1, -1};
    plane.motion.rotation_rate = 1.7;
    plane.motion.oscillation_amplitude = {0.05, 0.02, 0};
    plane.motion.oscillation_frequency = 3;
    const double t = 2.345, h = 1e-6;
    const PlaneState a = plane_at(plane, t - h), b = plane_at(plane, t + h), s = plane_at(plane, t);
    expect_near((b.point - a.point) * (0.5 / h), s.velocity + cross(s.angular_velocity, s.point - s.centre), 1e-7);
    expect_near((b.normal - a.normal) * (0.5 / h), cross(s.angular_velocity, s.normal), 1e-7);
    EXPECT_NEAR(length(s.normal), 1, 1e-15);
}

}  // namespace
}  // namespace grainray::test
