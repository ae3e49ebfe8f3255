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
    return std::string(name(info.param.device)) + "_" + info.param.backend + "_" + kinds[static_cast<int>(info.param.kind)];
}

class Search : public ::testing::TestWithParam<Case> {};

TEST_P(Search, EqualsTheOracleOnEveryCloud) {
    GRAINRAY_NEEDS(GetParam().device);
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
    GRAINRAY_NEEDS(GetParam().device);
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

TEST_P(Search, SeparateQueriesEqualAllPairs) {
    GRAINRAY_NEEDS(GetParam().device);
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

INSTANTIATE_TEST_SUITE_P(Backends, Search, ::testing::ValuesIn(cases()), case_name);

}  // namespace
}  // namespace grainray::test
