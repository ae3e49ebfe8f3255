// What the header promises besides the sets: layouts, errors, growth, order of ids.
#include <limits>

#include "clouds.hpp"
#include "devices.hpp"

namespace grainray::test {
namespace {

std::string refusal(const Cloud& cloud, SearchOptions options = {}) {
    try {
        NeighborSearch search(Device::cpu, options);
        NeighborList list;
        const DeviceCloud c(Device::cpu, cloud);
        search.find(c.points(), list);
    } catch (const InputError& e) {
        return e.what();
    }
    return "accepted";
}

TEST(Contract, InterleavedAndSeparateArraysGiveTheSameList) {
    const Cloud c = random_cloud("", 400, 0, 1, 0.1f, 1);
    std::vector<float> xyz, xyzr;
    for (std::size_t i = 0; i < c.size(); ++i) {
        xyz.insert(xyz.end(), {c.x[i], c.y[i], c.z[i]});
        xyzr.insert(xyzr.end(), {c.x[i], c.y[i], c.z[i], c.reach[i]});
    }
    NeighborSearch search;
    NeighborList list;
    search.find(DeviceCloud(Device::cpu, c).points(), list);
    const auto expected = rows_of(list);
    search.find(Points::xyz(xyz.data(), c.size(), 0.1f), list);
    EXPECT_EQ(rows_of(list), expected);
    const float* p = xyzr.data();
    search.find(Points{p, p + 1, p + 2, 4, p + 3, 4, 0, nullptr, c.size()}, list);
    EXPECT_EQ(rows_of(list), expected);
}

TEST(Contract, IdsDecideWhoOwnsAPairOfEqualReach) {
    const std::vector<float> x{0, 1}, zero{0, 0};
    const std::vector<std::uint32_t> ids{9, 4};
    Points points{x.data(), zero.data(), zero.data(), 1, nullptr, 1, 0.75f, ids.data(), 2};
    NeighborSearch search(Device::cpu, {"cells", ListKind::half, 1, true, {}, {}});
    NeighborList list;
    search.find(points, list);
    EXPECT_EQ(rows_of(list), (std::vector<std::vector<std::uint32_t>>{{1}, {}}));
}

TEST(Contract, BadPointsAreNamed) {
    Cloud c = random_cloud("", 50, 0, 1, 0.1f, 1);
    c.y[31] = std::numeric_limits<float>::quiet_NaN();
    c.y[40] = c.y[31];
    EXPECT_NE(refusal(c).find("point 31"), std::string::npos) << refusal(c);
    c = random_cloud("", 50, 0, 1, 0.1f, 1);
    c.z[7] = std::numeric_limits<float>::infinity();
    EXPECT_NE(refusal(c).find("point 7"), std::string::npos);
    c = random_cloud("", 50, 0, 1, 0.1f, 1);
    c.reach[3] = -1;
    EXPECT_NE(refusal(c).find("point 3 "), std::string::npos);
    EXPECT_NE(refusal(c).find("not negative"), std::string::npos);
}

TEST(Contract, UnknownBackendNamesTheKnownOnes) {
    const std::string message = refusal(random_cloud("", 5, 0, 1, 0.1f, 1), {"cell", ListKind::full, 1, true, {}, {}});
    EXPECT_NE(message.find("'cell'"), std::string::npos);
    EXPECT_NE(message.find("auto, brute, cells, rays, rays-published"), std::string::npos) << message;
}

TEST(Contract, BadBoxesAndBlocksAreRefused) {
    const Cloud c = random_cloud("", 5, 0, 1, 0.1f, 1);
    EXPECT_NE(refusal(c, {"auto", ListKind::full, 1, true, {}, {-1, 0, 0}}).find("periodic box"), std::string::npos);
    EXPECT_NE(refusal(c, {"auto", ListKind::blocked, 0, true, {}, {}}).find("block"), std::string::npos);
}

TEST(Contract, AStreamNeedsAGpu) {
    SearchOptions options;
    options.stream = &options;
    EXPECT_NE(refusal(random_cloud("", 5, 0, 1, 0.1f, 1), options).find("Device::cuda"), std::string::npos);
}

TEST(Contract, RowsHaveNoCap) {
    const Cloud c = random_cloud("", 3000, 0, 1, 10.0f, 1);
    NeighborSearch search(Device::cpu, {"cells", ListKind::full, 1, true, {}, {}});
    NeighborList list;
    search.find(DeviceCloud(Device::cpu, c).points(), list);
    EXPECT_EQ(list.neighbors.size(), 3000u * 2999u);
}

TEST(Contract, AutoMeasuresOnThePointsAndSaysSo) {
    const Cloud even = random_cloud("", 6000, 0, 1, 0.04f, 1);
    Cloud boulders = random_cloud("", 6000, 0, 1, 0.01f, 2);
    for (std::size_t i = 0; i < 6000; i += 40) boulders.reach[i] = 0.4f;
    for (const Device device : {Device::cpu, Device::cuda})
        for (const Cloud* c : {&even, static_cast<const Cloud*>(&boulders)}) {
            if (device == Device::cuda && !cuda_available()) continue;
            const DeviceCloud on_device(device, *c);
            NeighborSearch chosen(device), cells(device, {"cells", ListKind::full, 1, true, {}, {}});
            NeighborList list(device), expected(device);
            cells.find(on_device.points(), expected);
            for (int call = 0; call < 3; ++call) {
                chosen.find(on_device.points(), list);
                EXPECT_EQ(rows_of(list), rows_of(expected));
                const std::string reason = chosen.reason();
                const bool measured = reason.find("ms a search against") != std::string::npos;
                EXPECT_TRUE(measured || (c == &even && reason.find("left out") != std::string::npos)) << reason;
            }
            EXPECT_TRUE(chosen.backend() == "cells" || chosen.backend() == "rays") << chosen.backend();
        }
}

TEST(Contract, AFarOutlierCostsNoMemory) {
    Cloud c = random_cloud("", 20000, 0, 1, 0.02f, 1);
    NeighborSearch near(Device::cpu, {"cells", ListKind::half, 1, true, {}, {}}), far(Device::cpu, {"cells", ListKind::half, 1, true, {}, {}});
    NeighborList list;
    near.find(DeviceCloud(Device::cpu, c).points(), list);
    c.x.back() = 1e12f;
    far.find(DeviceCloud(Device::cpu, c).points(), list);
    EXPECT_LT(far.memory_bytes(), near.memory_bytes() * 5 / 4 + 65536);
}

TEST(Contract, AskingForAMissingGpuSaysSo) {
    if (cuda_available()) GTEST_SKIP() << "there is a GPU";
    try {
        NeighborSearch search(Device::cuda);
        FAIL() << "accepted";
    } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find("'cuda'"), std::string::npos);
    }
}

}  // namespace
}  // namespace grainray::test
