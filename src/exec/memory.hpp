// The memory functions of CUDA, behind pointers, so that nothing else needs to know whether CUDA was built in.
#pragma once

#include <cstddef>
#include <string>

#include "grainray/device.hpp"

namespace grainray::memory {

struct Cuda {
    bool (*available)();
    std::string (*status)();
    CudaReport (*report)();
    void* (*allocate)(std::size_t);
    void (*deallocate)(void*) noexcept;
    void (*copy)(void*, const void*, std::size_t);
    void (*clear)(void*, std::size_t);
    std::size_t (*peak)();
    std::size_t (*free)();
};
const Cuda& cuda();

}  // namespace grainray::memory
