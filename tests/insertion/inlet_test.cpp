// Inlets in front of surfaces, and what stands in the way of newcomers.
#include <filesystem>
#include <fstream>

#include "boundary/meshes.hpp"
#include "insertion/inlet.hpp"
#include "streams.hpp"

namespace grainray::test {
namespace {

/// A square of side 2 a round the origin in the plane z = 0, cut into 2 n x n triangles.
TriangleMesh square(double a, int n) {
    TriangleMesh m;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) m.vertices.push_back({a * (2.0 * i / n - 1), a * (2.0 * j / n - 1), 0});
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            m.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            m.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return m;
}

ParticleStream surface_stream(TriangleMesh geometry, double depth) {
    ParticleStream s = box_stream("s", {}, 300, 0.05);
    InletSurface inlet;
    inlet.surface.geometry = std::move(geometry);
    inlet.depth = depth;
    s.inlet = inlet;
    return s;
}

TEST(SurfaceInlet, PlacesFillTheSweptLayerEvenly) {
    Case c = empty_case();
    ParticleStream s = surface_stream(square(1, 3), 0.5);
    s.velocity = {1, 0, -1};  // slanting: the layer is thinner than it is deep
    const Inlet inlet(c.scene, s);
    const auto region = inlet.at(0);
    EXPECT_NEAR(region->volume, 4 * 0.5 / std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(inlet.crossing_time(), (std::sqrt(2 + 2 * 10 / std::sqrt(2.0) * 0.5) - std::sqrt(2.0)) / (10 / std::sqrt(2.0)), 1e-12);
    const scene::Random random(1, "x", scene::Stream::inlet);
    const double r = 0.05, height = 0.5 / std::sqrt(2.0);
    int places = 0, left = 0, high = 0;
    for (std::uint64_t k = 0; k < 20000; ++k) {
        const auto x = region->place(random, k, r);
        if (!x) continue;
        ++places;
        ASSERT_LE(x->z, -r + 1e-12);
        ASSERT_GE(x->z, -height + r - 1e-12);
        const double foot = x->x + x->z;  // where it came from along (1, 0, -1)
        ASSERT_LE(std::fabs(foot), 1 - r * std::sqrt(2.0) + 1e-9);  // seen along the way the edges are nearer
        ASSERT_LE(std::fabs(x->y), 1 - r + 1e-9);
        left += foot < 0;
        high += x->z > -height / 2;
    }
    EXPECT_NEAR(places / 20000.0, (1 - r * std::sqrt(2.0)) * (1 - r), 0.01);
    EXPECT_NEAR(left, places / 2, 300);
    EXPECT_NEAR(high, places / 2, 300);
}

TEST(SurfaceInlet, SaysWhatIsWrong) {
    const Case c = empty_case();
    const auto error = [&](const ParticleStream& s, const Scene& scene) {
        try {
            Inlet(scene, s);
        } catch (const InputError& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    ParticleStream s = surface_stream(square(1, 3), 0.5);
    EXPECT_EQ(error(s, c.scene), "");
    ParticleStream flat = s;
    flat.velocity = {1, 0, 0};
    EXPECT_NE(error(flat, c.scene).find("key 'streams.s': the inlet has no volume"), std::string::npos) << error(flat, c.scene);
    ParticleStream large = s;
    large.size.radius = 0.2;
    std::get<InletSurface>(large.inlet).surface.geometry = square(0.15, 1);
    EXPECT_NE(error(large, c.scene).find("0.4 m wide, fits nowhere"), std::string::npos) << error(large, c.scene);
    ParticleStream none = s;
    std::get<InletSurface>(none.inlet).facets = Box{{5, 5, 5}, {6, 6, 6}};
    EXPECT_NE(error(none, c.scene).find("streams.s.lower': no facet"), std::string::npos) << error(none, c.scene);
    Scene small = c.scene;
    small.domain.box = Box{{-1, -1, -0.3}, {1, 1, 1}};
    EXPECT_NE(error(s, small).find("from -0.5 to 0 m along z and the domain from -0.3"), std::string::npos) << error(s, small);
    Scene weightless = c.scene;
    weightless.gravity = {};
    ParticleStream still = s;
    still.velocity = {};
    EXPECT_NE(error(still, weightless).find("nothing carries the particles"), std::string::npos);
    ParticleStream zero = box_stream("s", {{0, 0, 0}, {1, 0, 1}}, 1);
    EXPECT_NE(error(zero, c.scene).find("no volume"), std::string::npos);
}

class Inlets : public ::testing::TestWithParam<Device> {
protected:
    void SetUp() override { GRAINRAY_NEEDS(GetParam()); }
};

TEST_P(Inlets, ASolidLidThatMovesTakesItsInletAlong) {
    Case c = empty_case();
    c.scene.gravity = {};
    add_mesh(c, square(0.5, 2), "lid");
    c.scene.meshes[0].translation = {0, 0, 2};
    c.scene.meshes[0].motion.velocity = {1, 0, 0};
    ParticleStream s = surface_stream({}, 0.3);
    auto& inlet = std::get<InletSurface>(s.inlet);
    inlet.surface = {};
    inlet.mesh = "lid";
    inlet.facets = Box{{-1, -1, 1.9}, {0.01, 1, 2.1}};  // one half of it
    s.interval = 0.1;
    s.rate.particles = 60;
    s.velocity = {0, 0, -3};
    c.scene.streams.push_back(s);
    Simulation simulation = c.start(GetParam());
    ASSERT_EQ(simulation.statistics().surfaces.size(), 1u);  // without a particle too
    std::uint32_t next = 0;
    for (int k = 1; k <= 8; ++k) {
        simulation.run(100);
        const Frame f = simulation.frame();
        ASSERT_EQ(f.size(), 6u * static_cast<unsigned>(k));
        for (std::size_t i = next; i < f.size(); ++i) {
            ASSERT_GE(f.position[i].x, -0.45 + 0.1 * k - 1e-6);
            ASSERT_LE(f.position[i].x, -0.05 + 0.1 * k + 1e-6);
            ASSERT_LE(f.position[i].z, 1.95 + 1e-6);
            ASSERT_GE(f.position[i].z, 1.75 - 1e-6);
        }
        next = static_cast<std::uint32_t>(f.size());
        ASSERT_EQ(simulation.statistics().contacts, 0u) << k;  // beside the lid, never in it
    }
}

TEST_P(Inlets, PlanesMeshesAndTheGroundAreKeptClear) {
    Case c = empty_case();
    c.scene.gravity = {};
    c.plane("side", {0.3, 0, 0}, Vec3d{-1, 0, 1} * std::sqrt(0.5));
    add_mesh(c, square(0.5, 4), "plate");
    c.scene.meshes[0].translation = {-0.2, -0.2, 0.4};
    c.scene.meshes[0].rotation = {0.7, 0.3, 0};
    c.scene.terrain.emplace();
    c.scene.terrain->material = "wall";
    c.scene.terrain->after = ElevationGrid{5, 5, -2, -2, 1, 1, {}};
    for (int k = 0; k < 25; ++k) c.scene.terrain->after->heights.push_back(0.15 * (k % 5 + k / 5) - 0.6);
    ParticleStream s = box_stream("s", {{-1, -1, -1}, {1, 1, 1}}, 2000, 0.06);
    s.interval = 0.001;
    s.velocity = {0, 0, 1e-6};
    c.scene.streams.push_back(s);
    Simulation simulation = c.start(GetParam());
    simulation.run(200);
    EXPECT_GT(simulation.size(), 150u);
    EXPECT_EQ(simulation.statistics().contacts, 0u);
    const Frame f = simulation.frame();
    int above_plate = 0, below_plate = 0;
    for (std::size_t i = 0; i < f.size(); ++i) {
        const Vec3d x = f.position[i];
        ASSERT_GT(x.z, c.scene.terrain->after->height(x.x, x.y)) << i;
        ASSERT_GT((x.z - x.x + 0.3) * std::sqrt(0.5), f.radius[i] - 1e-6) << i;
        (x.z > 0.4 ? above_plate : below_plate) += 1;
    }
    EXPECT_GT(above_plate, 20);
    EXPECT_GT(below_plate, 20);
}

INSTANTIATE_TEST_SUITE_P(Devices, Inlets, all_devices, device_name);

}  // namespace
}  // namespace grainray::test
