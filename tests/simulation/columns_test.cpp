// Histories of CUDA stand in fewer columns than rows have entries: scenes in which more pairs begin to touch within a list's
// life than there are columns for, against the CPU, which has a place for every entry.
#include "../boundary/meshes.hpp"
#include "devices.hpp"

namespace grainray::test {
namespace {

/// Spheres that barely do not touch, all on their way to the middle: whole slices without a contact, then all of them at once.
Case closing_in(int edge, double radius, double speed, Vec3d middle = {}) {
    Case c = empty_case();
    c.scene.gravity = {0, 0, -1};
    c.scene.search.interval = 60;
    c.scene.search.skin = 0.5;
    c.scene.materials[0].normal_stiffness = c.scene.materials[0].tangential_stiffness = 1e4;
    const double half = 0.5 * (edge - 1);
    for (int k = 0; k < edge; ++k)
        for (int j = 0; j < edge; ++j)
            for (int i = 0; i < edge; ++i) {
                const Vec3d x = Vec3d{i - half, j - half, k - half} * (2.02 * radius);
                c.add(middle + x, radius, x * -speed, {3.0 * (i % 3), -2.0 * (j % 2), 1});
            }
    return c;
}
Case cluster() { return closing_in(14, 0.1, 5); }
Case between_moving_planes() {
    Case c = closing_in(12, 0.1, 0.2);
    const double wall = 12 * 0.101 + 0.01;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            Vec3d point, normal;
            point[axis] = side * wall;
            normal[axis] = -side;
            c.plane("wall" + std::to_string(c.scene.planes.size()), point, normal);
            c.scene.planes.back().motion.velocity = normal * 3.0;
        }
    return c;
}
Case onto_a_mesh() {
    Case c = closing_in(12, 0.1, 5, {0, 0, 1.23});
    add_mesh(c, square(4, 8));
    c.scene.meshes.back().motion.velocity = {0, 0, 2};
    return c;
}
Case in_a_periodic_box() {
    Case c = closing_in(12, 0.1, 5);
    c.scene.domain.box = Box{{-1.22, -1.22, -3}, {1.22, 1.22, 3}};
    c.scene.domain.periodic = {true, true, false};
    return c;
}
/// One row comes to touch as many as it has entries, far more than its slice had columns for.
Case ball_into_a_nest() {
    Case c = closing_in(12, 0.05, 0.1);
    c.add({0, 0, 0.6 + 0.16}, 0.15, {0, 0, -12});
    return c;
}
/// Two sizes, close together: rows longer than 32 entries, and slices longer than 64.
Case many_sizes() {
    Case c = closing_in(13, 0.05, 4);
    for (std::size_t i = 0; i < c.initial.radii.size(); i += 37) c.initial.radii[i] *= 1.9;
    c.scene.materials[0].normal_stiffness = c.scene.materials[0].tangential_stiffness = 2e3;
    return c;
}

struct Crowd {
    const char* name;
    Case (*make)();
    bool runs_out;  ///< of spare columns
};
const Crowd crowds[] = {{"cluster", cluster, true}, {"between_moving_planes", between_moving_planes, true}, {"onto_a_mesh", onto_a_mesh, true},
                        {"in_a_periodic_box", in_a_periodic_box, true}, {"ball_into_a_nest", ball_into_a_nest, false}, {"many_sizes", many_sizes, true}};

class Columns : public ::testing::TestWithParam<Crowd> {};

TEST_P(Columns, LoseNoHistory) {
    GRAINRAY_NEEDS(Device::cuda);
    const Case c = GetParam().make();
    Simulation cpu = c.start(Device::cpu), gpu = c.start(Device::cuda);
    for (int batch = 0; batch < 8; ++batch) {
        cpu.run(15);
        gpu.run(15);
        ASSERT_EQ(gpu.state_hash(), cpu.state_hash()) << "after step " << gpu.step_count();
    }
    EXPECT_GT(gpu.statistics().contacts, c.initial.size());
    if (GetParam().runs_out) {
        EXPECT_GT(gpu.search().finished_steps, 0u) << "the scene is too calm to test what it is for";
    }
}

INSTANTIATE_TEST_SUITE_P(Crowds, Columns, ::testing::ValuesIn(crowds), [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace grainray::test
