// The forecast of device memory, and lists that must not outgrow it.
#include <gtest/gtest.h>

#include <numeric>

#include "grainray/simulation.hpp"

using namespace grainray;

namespace {

double forecast(const Scene& scene, const std::vector<double>& radii, const std::string& backend = "cells", double triangles = 0, double nodes = 0) {
    const auto parts = forecast_device_memory(scene, static_cast<double>(radii.size()), radii, backend, triangles, nodes);
    return std::accumulate(parts.begin(), parts.end(), 0.0, [](double sum, const MemoryPart& part) { return sum + part.bytes; });
}

}  // namespace

TEST(DeviceMemory, GrowsWithTheParticlesAndWithWhatTheSceneAdds) {
    const Scene plain;
    const std::vector<double> equal(100'000, 0.1);
    const double once = forecast(plain, equal), twice = forecast(plain, std::vector<double>(200'000, 0.1));
    const double a_particle = (twice - once) / 1e5;
    EXPECT_GT(a_particle, 400);
    EXPECT_LT(a_particle, 600);
    EXPECT_NEAR(2 * once - twice, forecast(plain, {}), 1e-6 * once);  // what no particle causes

    std::vector<double> boulders = equal;  // a few, so that lists take more than the search
    for (int k = 0; k < 4; ++k) boulders[k] = 3.2;
    const double before = forecast(plain, boulders);
    EXPECT_GT(before, once);
    boulders[4] = 3.2;  // about 2 * 3 * 33^2 small ones near, a row that 31 others are stored as wide as
    EXPECT_NEAR(forecast(plain, boulders) - before, 32 * 6 * 33 * 33 * 16, 0.1 * 32 * 6 * 33 * 33 * 16);
    EXPECT_NEAR(forecast(plain, equal, "rays") - once, 390 * 1e5, 0.1 * 390 * 1e5);

    Scene ground;
    ground.terrain.emplace();
    EXPECT_NEAR(forecast(ground, equal, "cells", 0, 1e6) - forecast(ground, equal), 8e6, 0.1 * 8e6);
}

