// Each primitive against the standard library, on every device and at sizes around the chunk borders.
#include "exec/primitives.hpp"

#include <algorithm>
#include <numeric>
#include <random>

#include "devices.hpp"

namespace grainray::test {
namespace {

const PrimitiveFunctions& on([[maybe_unused]] Device device) {
#ifdef GRAINRAY_HAS_CUDA
    if (device == Device::cuda) return cuda::primitive_functions;
#endif
    return cpu::primitive_functions;
}

class Primitives : public ::testing::TestWithParam<Device> {
protected:
    void SetUp() override { GRAINRAY_NEEDS(GetParam()); }
    const PrimitiveFunctions& f = on(GetParam());
    const std::vector<std::size_t> sizes{0, 1, 2, 1000, 32767, 32768, 32769, 65537, 300000};

    static std::vector<std::uint32_t> random(std::size_t n, std::uint32_t most) {
        std::mt19937 e(static_cast<unsigned>(n));
        std::vector<std::uint32_t> v(n);
        for (auto& x : v) x = std::uniform_int_distribution<std::uint32_t>(0, most)(e);
        return v;
    }
};

TEST_P(Primitives, ScanIsExclusiveAndReturnsTheTotal) {
    for (const std::size_t n : sizes) {
        const auto in = random(n, 1000);
        std::vector<std::uint64_t> values(in.begin(), in.end()), expected(n);
        std::exclusive_scan(values.begin(), values.end(), expected.begin(), std::uint64_t{0});
        EXPECT_EQ(f.scan(values), std::accumulate(in.begin(), in.end(), std::uint64_t{0})) << n;
        EXPECT_EQ(values, expected) << n;
    }
}

TEST_P(Primitives, SortIsStable) {
    for (const std::size_t n : sizes)
        for (const int bits : {1, 9, 11, 23, 32}) {
            auto keys = random(n, bits == 32 ? ~0u : (1u << bits) - 1);
            std::vector<std::uint32_t> values(n), order(n);
            std::iota(values.begin(), values.end(), 0u);
            order = values;
            std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return keys[a] < keys[b]; });
            auto sorted = keys;
            std::sort(sorted.begin(), sorted.end());
            f.sort(keys, values, bits);
            EXPECT_EQ(keys, sorted) << n << " " << bits;
            EXPECT_EQ(values, order) << n << " " << bits;
        }
}

TEST_P(Primitives, ReduceAddsEverythingAndRepeatsToTheBit) {
    for (const std::size_t n : sizes) {
        const auto in = random(n, 1u << 30);
        std::vector<double> values(in.begin(), in.end());
        const double exact = static_cast<double>(std::accumulate(in.begin(), in.end(), std::uint64_t{0}));
        EXPECT_EQ(f.sum(values), exact) << n;  // integers below 2^53: exact in any order
        for (double& v : values) v = 1.0 / (v + 1);
        EXPECT_EQ(f.sum(values), f.sum(values));
    }
}

TEST_P(Primitives, ReduceCallsItsFunctionOnceForEach) {
    auto all = sizes;
    all.push_back(5'000'000);
    for (const std::size_t n : all) {
        std::uint64_t sum = 1;
        EXPECT_EQ(f.calls(n, sum), std::vector<std::uint32_t>(n, 1)) << n;
        EXPECT_EQ(sum, n ? n * (n - 1) / 2 : 0) << n;
    }
}

TEST_P(Primitives, AtomicsLoseNothing) {
    const auto values = random(300000, 1u << 20);
    std::vector<std::uint32_t> expected(7, 0);
    for (const auto v : values) ++expected[v % 7];
    EXPECT_EQ(f.histogram(values, 7), expected);
    const std::uint32_t limit = (1u << 20) - 50;
    const auto first = std::find_if(values.begin(), values.end(), [&](auto v) { return v > limit; });
    EXPECT_EQ(f.first_above(values, limit), first == values.end() ? ~0u : static_cast<std::uint32_t>(first - values.begin()));
}

INSTANTIATE_TEST_SUITE_P(Devices, Primitives, all_devices, device_name);

}  // namespace
}  // namespace grainray::test
