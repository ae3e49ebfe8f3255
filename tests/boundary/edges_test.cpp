// Edges, corners and rims: no jump of energy, no passing through.
#include "devices.hpp"
#include "meshes.hpp"

namespace grainray::test {
namespace {

constexpr double radius = 0.1, weight_times_radius = 4.0 / 3 * 3.14159265358979 * 0.001 * 2000 * 10 * 0.1;

/// No friction, no damping: whatever energy changes is the boundary's fault.
Case lossless(double stiffness) {
    Case c = empty_case();
    c.scene.dt = 5e-5;
    c.scene.contact.mass_damping = 0;
    for (Material& m : c.scene.materials) {
        m.friction = m.normal_damping = 0;
        m.normal_stiffness = stiffness;
        m.tangential_stiffness = stiffness * 2 / 7;
    }
    return c;
}

/// Strips along y over a profile of (x, z).
TriangleMesh folded(const std::vector<std::pair<double, double>>& profile) {
    TriangleMesh m;
    for (const auto& [x, z] : profile) {
        m.vertices.push_back({x, -3, z});
        m.vertices.push_back({x, 3, z});
    }
    for (std::uint32_t a = 0; a + 3 < m.vertices.size(); a += 2) {
        m.triangles.push_back({a, a + 2, a + 3});
        m.triangles.push_back({a, a + 3, a + 1});
    }
    return m;
}

class Edges : public ::testing::TestWithParam<Device> {
protected:
    void SetUp() override { GRAINRAY_NEEDS(GetParam()); }

    /// Largest change of energy at moments of free flight, over m g r.
    double change(const Case& c, int steps, int every = 20) const {
        Simulation s = c.start(GetParam());
        const double start = energy(s.statistics());
        double most = 0;
        for (int k = 0; k < steps / every; ++k) {
            s.run(every);
            const Statistics now = s.statistics();
            if (now.contacts == 0) most = std::max(most, std::fabs(energy(now) - start));
        }
        s.check_health();
        return most / weight_times_radius;
    }
};

TEST_P(Edges, SlidesOverTheEdgeOfABox) {
    for (const double speed : {0.1, 0.5, 2.0}) {
        Case c = lossless(1e6);
        c.add({-0.3, 0.01, radius - 83.8e-6}, radius, {speed, 0, 0});
        add_mesh(c, box({-2, -2, -2}, {0, 2, 0}));
        Simulation s = c.start(GetParam());
        s.run(static_cast<std::uint64_t>(0.6 / speed / c.scene.dt) + 4000);
        EXPECT_GT(s.frame().position[0].x, 0) << speed;
        EXPECT_LT(s.frame().position[0].z, -0.1) << speed;
        EXPECT_LT(change(c, static_cast<int>(0.6 / speed / c.scene.dt) + 4000), 0.02) << speed;
    }
}

TEST_P(Edges, RollsOverTheEdgeOfABox) {  // with friction, without loss: rolling does not slip much before it leaves
    Case c = lossless(1e6);
    for (Material& m : c.scene.materials) m.friction = 1;
    c.add({-0.3, 0.01, radius - 83.8e-6}, radius, {1, 0, 0}, {0, 10, 0});
    add_mesh(c, box({-2, -2, -2}, {0, 2, 0}));
    EXPECT_LT(change(c, 12000), 0.03);
}

TEST_P(Edges, FallsOnAnEdgeAndOnACorner) {
    for (const double x : {-0.05, -0.01, 0.0, 0.03, 0.06}) {
        Case c = lossless(1e6);
        c.add({x, 0.01, 0.3}, radius, {0.2, 0, 0});
        add_mesh(c, box({-2, -2, -2}, {0, 2, 0}));
        EXPECT_LT(change(c, 6000), 0.01) << x;
    }
    Case c = lossless(1e6);
    c.add({0.02, 0.03, 0.3}, radius);
    add_mesh(c, box({-2, -2, -2}, {0, 0, 0}));
    EXPECT_LT(change(c, 6000), 0.01);
}

/// Overlaps of 0.3 to 0.7 r, where the discs of the two planes say little about the volume cut off.
TEST_P(Edges, SoftSpheresOnSharpEdges) {
    const std::vector<std::pair<double, double>> ridge{{-2, -3.4641016}, {0, 0}, {2, -3.4641016}};
    for (const TriangleMesh& mesh : {box({-2, -2, -2}, {0, 2, 0}), box({-2, -2, -2}, {0, 0, 0}), folded(ridge)})
        for (const double x : {-0.06, -0.03, 0.0, 0.03}) {
            Case c = lossless(1e5);
            c.add({x, 0.3 * x, 0.3}, radius, {0.2, 0, 0});
            add_mesh(c, mesh);
            EXPECT_LT(change(c, 6000), 0.02) << mesh.vertices.size() << " " << x;
        }
}

TEST_P(Edges, BouncesInConcaveCorners) {
    const std::vector<std::vector<std::pair<double, double>>> profiles{
        {{-2, 2}, {0, 0}, {2, 2}}, {{-3, 3}, {0, 0}, {3, 0}}, {{-3, 0}, {0, 0}, {0, 3}}, {{-3, 0.3}, {0, 0}, {3, 0.3}}};
    for (const auto& profile : profiles) {
        Case c = lossless(1e6);
        c.add({-0.45, 0.01, 0.95}, radius, {0.6, 0, 0});
        add_mesh(c, folded(profile));
        EXPECT_LT(change(c, 30000), 0.03) << profile[0].second << " " << profile[2].second;
    }
}

TEST_P(Edges, BouncesInABowl) {
    std::vector<std::pair<double, double>> bowl;
    for (int i = -12; i <= 12; ++i) bowl.emplace_back(2 * std::sin(i * 0.12), 2 - 2 * std::cos(i * 0.12));
    Case c = lossless(1e6);
    c.add({-0.5, 0.01, 0.4}, radius, {1, 0, 0});
    add_mesh(c, folded(bowl));
    EXPECT_LT(change(c, 40000), 0.02);
}

/// The corner of one mesh holds a sphere as two planes do, friction and all.
TEST_P(Edges, CornerIsTwoPlanes) {
    Case planes = empty_case();
    planes.scene.dt = 2e-4;
    planes.scene.gravity = {-6, 0, -8};
    planes.add({0.4, 0, 0.3}, radius, {-1, 0.5, 0}, {1, 2, 3});
    Case mesh = planes;
    planes.plane("floor", {0, 0, 0}, {0, 0, 1});
    planes.plane("wall", {0, 0, 0}, {1, 0, 0});
    add_mesh(mesh, folded({{0, 5}, {0, 0}, {5, 0}}));
    for (Case* c : {&planes, &mesh})
        for (Material& m : c->scene.materials) m.normal_stiffness = 1e6, m.tangential_stiffness = 2e5;
    Simulation a = planes.start(GetParam()), b = mesh.start(GetParam());
    for (int k = 0; k < 100; ++k) {
        a.run(50);
        b.run(50);
        const Frame fa = a.frame(), fb = b.frame();
        ASSERT_LT(length(fa.position[0] - fb.position[0]), 1e-3) << a.step_count();
        ASSERT_LT(length(fa.velocity[0] - fb.velocity[0]), 5e-3F) << a.step_count();
    }
    EXPECT_EQ(b.frame().coordination[0], 1u);
}

TEST_P(Edges, RimOfASheetActsAsAWire) {
    Case c = lossless(1e6);
    c.add({0.03, 0, 1.0}, radius, {0, 0, -1});
    TriangleMesh sheet = square(0.5, 1);
    for (Vec3d& v : sheet.vertices) v = {v.z, v.y, v.x};  // upright, its rim at z = 0.5
    add_mesh(c, sheet);
    EXPECT_LT(change(c, 8000), 0.02);
    Case leaves = lossless(1e6);
    leaves.add({-0.2, 0, 0.0999}, radius, {0.5, 0, 0});
    add_mesh(leaves, square(0.2, 1));
    EXPECT_LT(change(leaves, 24000), 0.02);
}

TEST_P(Edges, BothSidesOfASheetAreSolid) {
    Case c = empty_case();
    c.scene.dt = 2e-4;
    c.add({0, 0, 0.3}, radius);
    c.add({0.5, 0, -0.3}, radius, {0, 0, 6});
    add_mesh(c, square(1, 3));
    Simulation s = c.start(GetParam());
    double highest = -1;
    for (int k = 0; k < 60; ++k) {
        s.run(20);
        highest = std::max(highest, s.frame().position[1].z);
    }
    EXPECT_NEAR(s.frame().position[0].z, 0.1, 0.005);
    EXPECT_LT(highest, -0.08);
    s.check_health();
}

/// Less than a diameter a step and less energy than the contact can hold: stopped. Otherwise: reported.
TEST_P(Edges, FastParticlesAreStoppedOrReported) {
    for (const int n : {1, 20})
        for (int k = 0; k < 25; ++k) {
            Case c = empty_case();
            c.scene.gravity = {};
            c.scene.dt = 1e-3;
            c.scene.materials[1].normal_stiffness = 1e7;
            c.scene.limits.speed = 1e6;
            const double speed = 190;  // 1.9 radii a step
            c.add({0.1, 0.05, 0.9 + 0.02 * k}, radius, {0, 0, -speed});
            add_mesh(c, square(1, n));
            c.scene.materials[1].normal_stiffness = 8e6;
            Simulation s = c.start(GetParam());
            s.run(40);
            EXPECT_GT(s.frame().position[0].z, 0) << k;
        }
    int reported = 0;
    for (int k = 0; k < 20; ++k) {
        Case c = empty_case();
        c.scene.gravity = {};
        c.scene.limits.speed = 1e6;
        c.add({0.1, 0.05, 0.9 + 0.03 * k}, radius, {0, 0, -700});  // 7 radii a step
        add_mesh(c, square(1, 20), "sieve");
        Simulation s = c.start(GetParam());
        s.run(6);
        const bool through = s.frame().position[0].z < 0;
        std::string message;
        try {
            s.check_health();
        } catch (const SimulationError& e) {
            message = e.what();
        }
        EXPECT_EQ(through, message.find("went through mesh 'sieve'") != std::string::npos) << k << message;
        reported += through;
    }
    EXPECT_GT(reported, 5);
}

INSTANTIATE_TEST_SUITE_P(Devices, Edges, all_devices, device_name);

}  // namespace
}  // namespace grainray::test
