// Arrays on a CUDA device.
#include "exec/memory.hpp"

#include "exec/cuda_error.hpp"
#include "exec/gpus.hpp"

namespace grainray {
namespace {

using grainray::cuda::probe;

void* allocate(std::size_t bytes) {
    if (!probe().available) throw InputError("device 'cuda' asked for, but " + probe().status);
    void* p = nullptr;
    if (cudaMalloc(&p, bytes) != cudaSuccess) {
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
        [](void* p) noexcept { cudaFree(p); },
        [](void* to, const void* from, std::size_t bytes) { grainray::cuda::check(cudaMemcpy(to, from, bytes, cudaMemcpyDefault), "copy"); },
        [](void* p, std::size_t bytes) { grainray::cuda::check(cudaMemset(p, 0, bytes), "clear"); }};
    return present;
}

}  // namespace grainray
