// Arrays on any device. The CUDA half is in memory.cu, or absent.
#include "exec/memory.hpp"

#include <cstdlib>
#include <cstring>
#include <new>

#include "grainray/device.hpp"

namespace grainray {
namespace {

constexpr std::size_t alignment = 64;  // a cache line, and an AVX-512 vector

[[noreturn]] void out_of_memory(std::size_t bytes) {
    throw SimulationError("out of memory: could not allocate " + std::to_string(bytes >> 20) +
                          " MiB; use fewer particles or a machine with more memory");
}

}  // namespace

bool cuda_available() { return memory::cuda().available(); }
std::string cuda_status() { return memory::cuda().status(); }
std::size_t cuda_peak_bytes() { return memory::cuda().peak(); }
std::size_t cuda_free_bytes() { return memory::cuda().free(); }
CudaReport cuda_report() { return memory::cuda().report(); }

namespace detail {

void* allocate(Device device, std::size_t bytes) {
    if (bytes == 0) return nullptr;
    if (device == Device::cuda) return memory::cuda().allocate(bytes);
    void* p = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
    if (!p) out_of_memory(bytes);
    return p;
}

void deallocate(Device device, void* p) noexcept {
    if (!p) return;
    if (device == Device::cuda) memory::cuda().deallocate(p);
    else std::free(p);
}

void copy(Device to_device, void* to, Device from_device, const void* from, std::size_t bytes) {
    if (to_device == Device::cpu && from_device == Device::cpu) std::memcpy(to, from, bytes);
    else memory::cuda().copy(to, from, bytes);
}

void clear(Device device, void* p, std::size_t bytes) {
    if (device == Device::cpu) std::memset(p, 0, bytes);
    else memory::cuda().clear(p, bytes);
}

}  // namespace detail

#ifndef GRAINRAY_HAS_CUDA
const memory::Cuda& memory::cuda() {
    static const Cuda absent{
        [] { return false; },
        [] { return std::string("this build has no CUDA: nvcc was not found when it was configured; install the CUDA toolkit and build again"); },
        [] { return CudaReport{}; },
        [](std::size_t) -> void* { throw InputError("device 'cuda' asked for, but " + cuda_status()); },
        [](void*) noexcept {}, [](void*, const void*, std::size_t) {}, [](void*, std::size_t) {}, [] { return std::size_t{0}; }, [] { return std::size_t{0}; }};
    return absent;
}
#endif

}  // namespace grainray
