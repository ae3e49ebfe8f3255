// Arrays on a CUDA device.
#include "exec/memory.hpp"

#include <cstdint>

#include "exec/cuda_error.hpp"
#include "exec/gpus.hpp"

namespace grainray {
namespace {

using grainray::cuda::probe;

/// The driver's pool, which keeps what is freed: memory that a list update needs for a moment serves the next one.
cudaMemPool_t pool() {
    static const cudaMemPool_t keeping = [] {
        cudaMemPool_t p{};
        std::uint64_t everything = ~std::uint64_t{0};
        grainray::cuda::check(cudaDeviceGetDefaultMemPool(&p, 0), "memory pool");
        grainray::cuda::check(cudaMemPoolSetAttribute(p, cudaMemPoolAttrReleaseThreshold, &everything), "memory pool");
        return p;
    }();
    return keeping;
}

/// Sizes in steps of about a sixteenth: arrays whose size drifts fit where they were before.
std::size_t rounded(std::size_t bytes) {
    std::size_t step = 512;
    while (step * 32 < bytes) step *= 2;
    return (bytes + step - 1) / step * step;
}

void* allocate(std::size_t bytes) {
    if (!probe().available) throw InputError("device 'cuda' asked for, but " + probe().status);
    bytes = rounded(bytes);
    void* p = nullptr;
    if (cudaMallocFromPoolAsync(&p, bytes, pool(), nullptr) == cudaSuccess) return p;
    cudaGetLastError();
    cudaDeviceSynchronize();
    cudaMemPoolTrimTo(pool(), 0);  // what is free but cut into pieces goes back to the driver
    if (cudaMallocFromPoolAsync(&p, bytes, pool(), nullptr) != cudaSuccess) {
        cudaGetLastError();
        std::size_t free = 0, total = 0;
        cudaMemGetInfo(&free, &total);
        throw SimulationError("out of GPU memory: " + std::to_string(bytes >> 20) + " MiB asked for, " +
                              std::to_string(free >> 20) + " MiB free; use fewer particles or --device cpu");
    }
    return p;
}

}  // namespace

const memory::Cuda& memory::cuda() {
    static const Cuda present{
        [] { return probe().available; },
        [] { return probe().status; },
        grainray::cuda::report,
        allocate,
        [](void* p) noexcept { cudaFreeAsync(p, nullptr); },
        [](void* to, const void* from, std::size_t bytes) { grainray::cuda::check(cudaMemcpy(to, from, bytes, cudaMemcpyDefault), "copy"); },
        [](void* p, std::size_t bytes) { grainray::cuda::check(cudaMemset(p, 0, bytes), "clear"); },
        [] {
            std::uint64_t bytes = 0;
            if (probe().available) grainray::cuda::check(cudaMemPoolGetAttribute(pool(), cudaMemPoolAttrUsedMemHigh, &bytes), "memory pool");
            return static_cast<std::size_t>(bytes);
        },
        [] {
            std::size_t free = 0, total = 0;
            if (probe().available) grainray::cuda::check(cudaMemGetInfo(&free, &total), "memory");
            return free;
        }};
    return present;
}

}  // namespace grainray
