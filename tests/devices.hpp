// Devices as a test parameter: CUDA cases skip where there is no GPU.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "grainray/device.hpp"

namespace grainray::test {

inline const auto all_devices = ::testing::Values(Device::cpu, Device::cuda);

inline std::string device_name(const ::testing::TestParamInfo<Device>& info) { return std::string(name(info.param)); }

#define GRAINRAY_NEEDS(device) \
    if ((device) == ::grainray::Device::cuda && !::grainray::cuda_available()) GTEST_SKIP() << ::grainray::cuda_status()

}  // namespace grainray::test
