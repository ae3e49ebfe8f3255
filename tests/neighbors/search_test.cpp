// Every back end on every device passes this one body against the oracle: equal sets, row by row.
#include "clouds.hpp"
#include "devices.hpp"

namespace grainray::test {
namespace {

struct Case {
    Device device;
    std::string backend;
    ListKind kind;
};

std::vector<Case> cases() {
    std::vector<Case> all;
    for (const Device device : {Device::cpu, Device::cuda})
        for (const BackendInfo& b : search_backends(device))
            for (const ListKind kind : {ListKind::half, ListKind::full, ListKind::blocked}) all.push_back({device, b.name, kind});
    return all;
}

std::string case_name(const ::testing::TestParamInfo<Case>& info) {
    const char* kinds[] = {"half", "full", "blocked"};
    std::string text = std::string(name(info.param.device)) + "_" + info.param.backend + "_" + kinds[static_cast<int>(info.param.kind)];
    std::replace(text.begin(), text.end(), '-', '_');
    return text;
}

class Search : public ::testing::TestWithParam<Case> {
protected:
    void SetUp() override {
        for (const BackendInfo& b : search_backends(GetParam().device))
            if (b.name == GetParam().backend && !b.available) GTEST_SKIP() << b.reason;
    }
};

TEST_P(Search, EqualsTheOracleOnEveryCloud) {
    for (const Cloud& cloud : adversarial_clouds()) {
        SCOPED_TRACE(cloud.name);
        SearchOptions options{GetParam().backend, GetParam().kind, 37, true, cloud.lower, cloud.period};
        NeighborSearch search(GetParam().device, options);
        NeighborList list(GetParam().device);
        const DeviceCloud on_device(GetParam().device, cloud);
        search.find(on_device.points(), list);
        EXPECT_EQ(rows_of(list), Oracle{cloud}.rows(GetParam().kind, 37));
        search.find(on_device.points(), list);  // the buffers of the first call serve the second
        EXPECT_EQ(rows_of(list), Oracle{cloud}.rows(GetParam().kind, 37)) << "second call";
    }
}

TEST_P(Search, UnsortedRowsHoldTheSameSets) {
    const Cloud cloud = random_cloud("", 2000, 0, 1, 0.06f, 77);
    SearchOptions options{GetParam().backend, GetParam().kind, 100, false, {}, {}};
    NeighborSearch search(GetParam().device, options);
    NeighborList list(GetParam().device);
    const DeviceCloud on_device(GetParam().device, cloud);
    search.find(on_device.points(), list);
    auto rows = rows_of(list);
    for (auto& row : rows) std::sort(row.begin(), row.end());
    EXPECT_EQ(rows, Oracle{cloud}.rows(GetParam().kind, 100));
}

TEST_P(Search, ListsThatWouldBeTooLongStayWithoutRows) {
    const bool known_too_late = GetParam().device == Device::cuda && GetParam().backend.starts_with("rays");
    Cloud equal = random_cloud("", 1500, 0, 1, 0.06f, 78), unequal = equal, boulders = random_cloud("", 1500, 0, 1, 0.02f, 79);
    for (std::size_t i = 0; i < unequal.size(); ++i) unequal.reach[i] *= 0.5f + 0.1f * static_cast<float>(i % 11);
    for (std::size_t i = 0; i < boulders.size(); i += 100) boulders.reach[i] = 0.2f;  // many threads of CUDA look around each
    for (const Cloud* cloud : {&equal, &unequal, &boulders}) {
        const auto expected = Oracle{*cloud}.rows(GetParam().kind, 37);
        std::size_t entries = 0;
        for (const auto& row : expected) entries += row.size();
        SearchOptions options{GetParam().backend, GetParam().kind, 37, true, {}, {}, true};
        NeighborSearch search(GetParam().device, options);
        NeighborList list(GetParam().device);
        const DeviceCloud on_device(GetParam().device, *cloud);
        for (const std::size_t most : {entries, entries - 1, std::size_t{3}, 100 * entries}) {
            search.set_most_entries(most);
            search.find(on_device.points(), list);
            EXPECT_EQ(rows_of(list), most < entries && !known_too_late ? std::vector<std::vector<std::uint32_t>>{} : expected) << most;
        }
    }
}

// As a simulation asks: points in the order of space (said of any order, since only speed may depend on it), extents known.
TEST_P(Search, WhatIsKnownOfThePointsChangesNothing) {
    for (const Cloud& cloud : adversarial_clouds()) {
        SCOPED_TRACE(cloud.name);
        SearchOptions options{GetParam().backend, GetParam().kind, 37, true, cloud.lower, cloud.period, true};
        NeighborSearch search(GetParam().device, options);
        NeighborList list(GetParam().device);
        const DeviceCloud on_device(GetParam().device, cloud);
        const Extents extents = extents_of(cloud);
        Points points = on_device.points();
        for (const Extents* known : {static_cast<const Extents*>(nullptr), &extents}) {
            points.extents = known;
            search.find(points, list);
            EXPECT_EQ(rows_of(list), Oracle{cloud}.rows(GetParam().kind, 37)) << (known ? "extents known" : "extents not known");
        }
    }
}

TEST_P(Search, SeparateQueriesEqualAllPairs) {
    for (const Cloud& cloud : adversarial_clouds()) {
        SCOPED_TRACE(cloud.name);
        Cloud queries = random_cloud("queries", 97, -1, 2, 0.04f, 5);
        for (std::size_t i = 0; i < cloud.size(); i += 7) queries.add(cloud.x[i], cloud.y[i], cloud.z[i], 0.5f * cloud.reach[i]);
        Cloud both = cloud;
        for (std::size_t q = 0; q < queries.size(); ++q) both.add(queries.x[q], queries.y[q], queries.z[q], queries.reach[q]);
        std::vector<std::vector<std::uint32_t>> expected(queries.size());
        for (std::uint32_t q = 0; q < queries.size(); ++q)
            for (std::uint32_t j = 0; j < cloud.size(); ++j)
                if (Oracle{both}.neighbors(cloud.size() + q, j)) expected[q].push_back(j);

        NeighborSearch search(GetParam().device, {GetParam().backend, GetParam().kind, 37, true, cloud.lower, cloud.period});
        NeighborList list(GetParam().device);
        const DeviceCloud points(GetParam().device, cloud), asked(GetParam().device, queries);
        search.find(asked.points(), points.points(), list);
        EXPECT_EQ(rows_of(list), expected);
    }
}

// A simulation moves its points and sorts them anew before each search; what a back end keeps must follow the ids.
TEST_P(Search, FollowsPointsThatMoveAndChangePlaces) {
    Cloud cloud = random_cloud("", 700, 0, 1, 0.05f, 41);
    std::vector<std::uint32_t> id(cloud.size());
    for (std::uint32_t i = 0; i < id.size(); ++i) {
        id[i] = 2 * i + 5;
        cloud.reach[i] *= 1 + 0.5f * static_cast<float>(i % 7) + 1e-4f * static_cast<float>(i);  // no two alike: ids break no tie
    }
    std::mt19937 e(42);
    std::uniform_real_distribution<float> move(-0.03f, 0.03f);
    NeighborSearch search(GetParam().device, {GetParam().backend, GetParam().kind, 37, true, {}, {}});
    NeighborList list(GetParam().device);
    for (int step = 0; step < 24; ++step) {
        SCOPED_TRACE(step);
        const DeviceCloud on_device(GetParam().device, cloud);
        const Array<std::uint32_t> ids(GetParam().device, id);
        Points points = on_device.points();
        points.ids = ids.data();
        search.find(points, list);
        ASSERT_EQ(rows_of(list), Oracle{cloud}.rows(GetParam().kind, 37));
        for (std::size_t i = 0; i < cloud.size(); ++i) {
            cloud.x[i] += move(e), cloud.y[i] += move(e), cloud.z[i] += move(e);
            const std::size_t j = e() % cloud.size();
            std::swap(cloud.x[i], cloud.x[j]), std::swap(cloud.y[i], cloud.y[j]), std::swap(cloud.z[i], cloud.z[j]);
            std::swap(cloud.reach[i], cloud.reach[j]), std::swap(id[i], id[j]);
        }
        if (step % 8 == 7) {  // one leaves, one comes
            cloud.x.back() = 0.5f;
            id.back() += 10000;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, Search, ::testing::ValuesIn(cases()), case_name);

}  // namespace
}  // namespace grainray::test
