// Every validation case as a test, on every device.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "devices.hpp"
#include "grainray/validation.hpp"

namespace grainray::test {
namespace {

using Parameter = std::tuple<Device, ValidationCase>;

class Case : public ::testing::TestWithParam<Parameter> {};
class SlowCase : public Case {};

std::string test_name(const ::testing::TestParamInfo<Parameter>& info) {
    std::string text = std::get<1>(info.param).name + "_" + std::string(name(std::get<0>(info.param)));
    std::replace_if(text.begin(), text.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
    return text;
}

bool is_column(const ValidationCase& c) { return c.name.starts_with("column"); }

std::vector<ValidationCase> quick_cases(bool columns) {
    std::vector<ValidationCase> chosen;
    for (const ValidationCase& c : validation_cases())
        if (c.quick && is_column(c) == columns) chosen.push_back(c);
    return chosen;
}

void check(const Parameter& parameter) {
    const auto& [device, c] = parameter;
    GRAINRAY_NEEDS(device);
    SimulationOptions options;
    options.device = device;
    const auto results = c.run(c, options);
    EXPECT_FALSE(results.empty());
    for (const ValidationResult& r : results)
        EXPECT_TRUE(r.pass) << r.quantity << ": expected " << r.expected << ", got " << r.got << ", tolerance " << r.tolerance
                            << (r.relative ? " of it" : "") << " (" << r.source << ")";
}

TEST_P(Case, IsWithinTolerance) { check(GetParam()); }
TEST_P(SlowCase, IsWithinTolerance) { check(GetParam()); }

const auto devices = ::testing::Values(Device::cpu, Device::cuda);
INSTANTIATE_TEST_SUITE_P(All, Case, ::testing::Combine(devices, ::testing::ValuesIn(quick_cases(false))), test_name);
INSTANTIATE_TEST_SUITE_P(All, SlowCase, ::testing::Combine(devices, ::testing::ValuesIn(quick_cases(true))), test_name);

TEST(Validate, RunsTheNamedCasesInTheirOrder) {
    const auto results = validate({"piston", "free fall"}, true);
    ASSERT_FALSE(results.empty());
    EXPECT_EQ(results.front().name, "free fall");
    EXPECT_EQ(results.back().name, "piston");
}

TEST(Validate, NamesTheKnownCasesWhereOneIsUnknown) {
    try {
        validate({"free fal"}, true);
        FAIL();
    } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find("'free fal'"), std::string::npos);
        EXPECT_NE(std::string(e.what()).find("'column A'"), std::string::npos);
    }
}

}  // namespace
}  // namespace grainray::test
