// Which GPUs CUDA can use here, and one sentence where it can use none.
#pragma once

#include <string>

#include "grainray/device.hpp"

namespace grainray::cuda {

/// Of GPU 0, the one that simulations run on. Asked once.
struct Probe {
    bool available = false;
    std::string status;
};
const Probe& probe();

CudaReport report();

}  // namespace grainray::cuda
