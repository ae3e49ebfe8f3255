// Arrays: copies, growth, and what happens when there is no room or no GPU.
#include "devices.hpp"

namespace grainray::test {
namespace {

class Arrays : public ::testing::TestWithParam<Device> {
protected:
    void SetUp() override { GRAINRAY_NEEDS(GetParam()); }
};

TEST_P(Arrays, KeepWhatTheyAreGiven) {
    const std::vector<int> data{3, 1, 4, 1, 5};
    Array<int> a(GetParam(), data), b(GetParam());
    EXPECT_EQ(a.to_host(), data);
    b.assign(a);
    a.clear_bytes();
    EXPECT_EQ(a.to_host(), std::vector<int>(5, 0));
    EXPECT_EQ(b.to_host(), data);
    Array<int> moved = std::move(b);
    EXPECT_EQ(moved.to_host(), data);
    EXPECT_EQ(b.size(), 0u);
}

TEST_P(Arrays, NeverShrinkTheirMemory) {
    Array<int> a(GetParam(), 1000);
    const auto bytes = a.bytes();
    a.resize_discard(10);
    EXPECT_EQ(a.size(), 10u);
    EXPECT_EQ(a.bytes(), bytes);
    a.resize_discard_slack(1001);
    EXPECT_GT(a.bytes(), bytes);
}

TEST_P(Arrays, NoMemoryIsOneSentence) {
    try {
        Array<char> a(GetParam(), std::size_t{1} << 55);
        FAIL() << "allocated 32 PiB";
    } catch (const SimulationError& e) {
        EXPECT_NE(std::string(e.what()).find("memory"), std::string::npos) << e.what();
    }
}

INSTANTIATE_TEST_SUITE_P(Devices, Arrays, all_devices, device_name);

TEST(Gpu, AbsenceIsExplained) {
    EXPECT_FALSE(cuda_status().empty());
    if (!cuda_available()) {
        EXPECT_THROW((Array<int>(Device::cuda, 4)), InputError);
    }
}

}  // namespace
}  // namespace grainray::test
