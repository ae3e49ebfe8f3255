// CUDA status codes to exceptions.
#pragma once

#include <cuda_runtime_api.h>

#include <string>

#include "grainray/core.hpp"

namespace grainray::cuda {

inline void check(cudaError_t status, const char* what) {
    if (status != cudaSuccess)
        throw SimulationError(std::string("CUDA ") + what + " failed: " + cudaGetErrorString(status) +
                              " (run with --device cpu to go on without the GPU)");
}

}  // namespace grainray::cuda
