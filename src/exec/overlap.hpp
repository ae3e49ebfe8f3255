// Two kernels of which the second begins while the last blocks of the first still run, and waits for them where it needs
// what they write (programmatic dependent launch; GPUs before compute capability 9.0 run one after the other).
#pragma once

#include "exec/exec.hpp"

namespace grainray::GRAINRAY_EXEC {

#if defined(__CUDACC__)

inline constexpr unsigned first_threads = 128;

template <unsigned blocks_at_once, class F>
__global__ void __launch_bounds__(first_threads, blocks_at_once) first_kernel(std::size_t n, F f) {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 900
    asm volatile("griddepcontrol.launch_dependents;");  // once every block has come this far
#endif
    const std::size_t i = blockIdx.x * std::size_t{blockDim.x} + threadIdx.x;
    if (i < n) f(i);
}

/// for_each as the first. blocks_at_once: as many shall fit a multiprocessor, whatever registers that leaves a thread.
template <unsigned blocks_at_once, class F>
void for_each_first(std::size_t n, const F& f, std::size_t = 0) {
    if (n == 0) return;
    first_kernel<blocks_at_once><<<static_cast<unsigned>((n + first_threads - 1) / first_threads), first_threads>>>(n, f);
    check(cudaGetLastError(), "kernel launch");
}

/// In the second: the first has ended, and what it wrote can be seen.
__device__ inline void wait_for_first() {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 900
    asm volatile("griddepcontrol.wait;" ::: "memory");
#endif
}

/// Launches the second. One of its threads at least must wait_for_first, or what comes after it could overtake the first.
template <class... Parameters, class... Arguments>
void launch_second(void (*kernel)(Parameters...), unsigned blocks, unsigned threads, const Arguments&... arguments) {
    static const bool waits = [&] {
        cudaFuncAttributes code;
        check(cudaFuncGetAttributes(&code, kernel), "look at a kernel");
        return code.ptxVersion >= 90 && code.binaryVersion >= 90;
    }();
    cudaLaunchAttribute early;
    early.id = cudaLaunchAttributeProgrammaticStreamSerialization;
    early.val.programmaticStreamSerializationAllowed = 1;
    cudaLaunchConfig_t launch{};
    launch.gridDim = blocks;
    launch.blockDim = threads;
    launch.attrs = &early;
    launch.numAttrs = waits ? 1 : 0;
    check(cudaLaunchKernelEx(&launch, kernel, arguments...), "kernel launch");
}

#else

template <unsigned, class F>
void for_each_first(std::size_t n, const F& f, std::size_t grain) { for_each(n, f, grain); }

#endif

}  // namespace grainray::GRAINRAY_EXEC
