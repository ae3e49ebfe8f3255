// A plane of triangles answers as a plane: one triangle, two, 20,000 at random, flat or on a slope.
#include "devices.hpp"
#include "meshes.hpp"

namespace grainray::test {
namespace {

struct Kind {
    const char* name;
    TriangleMesh (*make)();
};
const Kind kinds[] = {{"one", [] { return one_triangle(2); }}, {"two", [] { return square(2, 1); }}, {"twenty_thousand", [] { return square(2, 100); }}};

class PlaneOfTriangles : public ::testing::TestWithParam<std::tuple<Device, Kind>> {
protected:
    void SetUp() override { GRAINRAY_NEEDS(std::get<0>(GetParam())); }

    /// Spheres that do not meet: one at rest, one that bounces, one that rolls, one that slides and spins, a small one.
    static Case spheres(const Vec3d& gravity) {
        Case c = empty_case();
        c.scene.gravity = gravity;
        c.scene.dt = 2e-4;
        c.scene.contact.mass_damping = 0;
        c.scene.materials[0].friction = c.scene.materials[1].friction = 0.3;
        c.scene.materials[1].normal_stiffness = 1e6;
        c.scene.materials[1].tangential_stiffness = 2.0 / 7.0 * 1e6;
        c.scene.materials[1].normal_damping = 0.1;
        c.add({-1.2, -1.5, 0.09999}, 0.1);
        c.add({-1.0, 0.7, 0.5}, 0.1, {0.3, 0.1, -1}, {3, 0, 1});
        c.add({-1.6, -1.0, 0.0999}, 0.1, {2, 0.2, 0}, {-2, 20, 0});
        c.add({-1.7, 0.0, 0.0999}, 0.1, {2.5, 0.1, 0}, {0, -30, 5});
        c.add({-1.7, 1.2, 0.05}, 0.05, {1.5, -0.2, 0}, {9, 9, 9});
        return c;
    }

    /// Largest difference of paths over the length of the path, and of contact forces over the weight.
    static void compare(Case on_plane, Case on_mesh, Device device, int batches) {
        Simulation plane = on_plane.start(device), mesh = on_mesh.start(device);
        std::vector<double> way(on_plane.initial.size(), 0.1);
        std::vector<Vec3d> last = on_plane.initial.positions;
        for (int k = 0; k < batches; ++k) {
            plane.run(50);
            mesh.run(50);
            const Frame a = plane.frame(), b = mesh.frame();
            for (std::size_t i = 0; i < a.size(); ++i) {
                way[i] += length(a.position[i] - last[i]);
                last[i] = a.position[i];
                const double weight = 10.0 * a.mass[i];
                ASSERT_LT(length(a.position[i] - b.position[i]), 1e-3 * way[i]) << "sphere " << i << " at step " << plane.step_count();
                ASSERT_LT(std::fabs(a.contact_force[i] - b.contact_force[i]), 1e-3 * std::max<double>(weight, a.contact_force[i])) << "sphere " << i << " at step " << plane.step_count();
                ASSERT_LT(length(convert<double>(a.angular_velocity[i] - b.angular_velocity[i])), 1e-3 * (1 + length(convert<double>(a.angular_velocity[i])))) << i;
            }
        }
        EXPECT_NO_THROW(mesh.check_health());
    }
};

TEST_P(PlaneOfTriangles, Flat) {
    const auto& [device, kind] = GetParam();
    Case plane = spheres({0, 0, -10}), mesh = plane;
    plane.plane("floor", {0, 0, 0}, {0, 0, 1});
    add_mesh(mesh, kind.make());
    compare(plane, mesh, device, 100);
}

TEST_P(PlaneOfTriangles, Slope) {  // gravity leans instead
    const auto& [device, kind] = GetParam();
    Case plane = spheres({3, 1, -9}), mesh = plane;
    plane.plane("floor", {0, 0, 0}, {0, 0, 1});
    add_mesh(mesh, kind.make());
    compare(plane, mesh, device, 60);
}

TEST_P(PlaneOfTriangles, TurnedInSpace) {
    const auto& [device, kind] = GetParam();
    const Vec3d angles{0.4, -0.7, 1.9};
    const auto turn = [&](Vec3d v) {
        v = turned(v, {1, 0, 0}, angles.x);
        v = turned(v, {0, 1, 0}, angles.y);
        return turned(v, {0, 0, 1}, angles.z);
    };
    const Vec3d shift{5, -3, 8};
    Case plane = spheres(turn({0, 0, -10})), mesh = plane;
    for (Case* c : {&plane, &mesh})
        for (std::size_t i = 0; i < c->initial.size(); ++i) {
            c->initial.positions[i] = turn(c->initial.positions[i]) + shift;
            c->initial.velocities[i] = turn(c->initial.velocities[i]);
            c->initial.angular_velocities[i] = turn(c->initial.angular_velocities[i]);
        }
    plane.plane("floor", shift, turn({0, 0, 1}));
    add_mesh(mesh, kind.make());
    mesh.scene.meshes[0].rotation = angles;
    mesh.scene.meshes[0].translation = shift;
    compare(plane, mesh, device, 60);
}

TEST_P(PlaneOfTriangles, DeepContactsOfSoftSpheres) {  // centres below the surface are pushed back as by a plane
    const auto& [device, kind] = GetParam();
    Case plane = spheres({0, 0, -10});
    plane.scene.materials[1].normal_stiffness = 4e3;
    plane.scene.materials[1].tangential_stiffness = 1e3;
    plane.scene.dt = 1e-3;
    for (auto& v : plane.initial.velocities) v.z = -1.5;
    Case mesh = plane;
    plane.plane("floor", {0, 0, 0}, {0, 0, 1});
    add_mesh(mesh, kind.make());
    Simulation probe = plane.start(device);
    double deepest = 0;
    for (int k = 0; k < 60; ++k) probe.run(5), deepest = std::max(deepest, probe.statistics().max_overlap_ratio);
    EXPECT_GT(deepest, 1.05);
    EXPECT_LT(deepest, 1.8);
    compare(plane, mesh, device, 10);
}

INSTANTIATE_TEST_SUITE_P(Kinds, PlaneOfTriangles, ::testing::Combine(all_devices, ::testing::ValuesIn(kinds)), [](const auto& one) {
    return std::string(name(std::get<0>(one.param))) + "_" + std::get<1>(one.param).name;
});

}  // namespace
}  // namespace grainray::test
