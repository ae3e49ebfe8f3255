// Primitives on one CUDA device, over CUB. Same contracts as exec/cpu.hpp.
#pragma once

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_reduce.cuh>
#include <cub/device/device_scan.cuh>
#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>

#include <array>

#include "exec/cuda_error.hpp"
#include "grainray/device.hpp"

namespace grainray::cuda {

inline constexpr Device device = Device::cuda;

template <class F>
__global__ void for_each_kernel(std::size_t n, F f) {
    const std::size_t i = blockIdx.x * std::size_t{blockDim.x} + threadIdx.x;
    if (i < n) f(i);
}

template <class F>
void for_each(std::size_t n, const F& f, std::size_t = 0) {
    if (n == 0) return;
    constexpr unsigned threads = 128;
    for_each_kernel<<<static_cast<unsigned>((n + threads - 1) / threads), threads>>>(n, f);
    check(cudaGetLastError(), "kernel launch");
}

template <class F>
__global__ void for_each_in_blocks_kernel(const std::uint32_t* count, F f) {
    const std::uint32_t items = *count, blocks_each = items && items < gridDim.x ? gridDim.x / items : 1;
    for (std::size_t b = blockIdx.x; b < std::size_t{items} * blocks_each; b += gridDim.x)
        f(b / blocks_each, static_cast<std::uint32_t>(b % blocks_each) * blockDim.x + threadIdx.x, blocks_each * blockDim.x);
}

/// f(i, share, shares) by many threads for each i below *count, a number on the device that the host need not know: by those of
/// a block, or of several blocks where there are few i.
template <class F>
void for_each_in_blocks(const std::uint32_t* count, const F& f) {
    constexpr unsigned blocks = 1024, threads = 128;
    for_each_in_blocks_kernel<<<blocks, threads>>>(count, f);
    check(cudaGetLastError(), "kernel launch");
}

/// Scratch memory of the primitives, kept from call to call.
inline void* scratch(std::size_t bytes) {
    static Array<char> memory(Device::cuda);
    memory.resize_discard_slack(bytes ? bytes : 1);
    return memory.data();
}

/// Waits for the device and reads one value from it.
template <class T>
T fetch(const T* value) {
    static T* const landing = [] {
        void* p = nullptr;
        check(cudaMallocHost(&p, sizeof(T)), "host memory");
        return static_cast<T*>(p);
    }();
    check(cudaMemcpyAsync(landing, value, sizeof(T), cudaMemcpyDeviceToHost), "copy");
    check(cudaStreamSynchronize(nullptr), "copy");
    return *landing;
}

template <class T, class F, class Op>
T reduce(std::size_t n, T identity, const F& f, const Op& op) {
    static Array<T> result(Device::cuda, 1);
    const auto values = thrust::make_transform_iterator(thrust::counting_iterator<std::size_t>(0), f);
    std::size_t bytes = 0;
    check(cub::DeviceReduce::Reduce(nullptr, bytes, values, result.data(), n, op, identity), "reduce");
    check(cub::DeviceReduce::Reduce(scratch(bytes), bytes, values, result.data(), n, op, identity), "reduce");
    return fetch(result.data());
}

template <class T>
T exclusive_scan(View<T> values) {
    if (values.size == 0) return T{};
    Array<T> total(Device::cuda, 1);
    const auto sum = total.view();
    const T* last = values.end() - 1;
    for_each(1, [=] GR_HD(std::size_t) { sum[0] = *last; });
    std::size_t bytes = 0;
    check(cub::DeviceScan::ExclusiveSum(nullptr, bytes, values.data, values.data, values.size), "scan");
    check(cub::DeviceScan::ExclusiveSum(scratch(bytes), bytes, values.data, values.data, values.size), "scan");
    for_each(1, [=] GR_HD(std::size_t) { sum[0] += *last; });
    return fetch(sum.data);
}

template <class Key>
void sort_by_key(Array<Key>& keys, Array<std::uint32_t>& values, Array<Key>& keys2, Array<std::uint32_t>& values2, int bits) {
    keys2.resize_discard(keys.size());
    values2.resize_discard(keys.size());
    cub::DoubleBuffer<Key> k(keys.data(), keys2.data());
    cub::DoubleBuffer<std::uint32_t> v(values.data(), values2.data());
    std::size_t bytes = 0;
    check(cub::DeviceRadixSort::SortPairs(nullptr, bytes, k, v, keys.size(), 0, bits), "sort");
    check(cub::DeviceRadixSort::SortPairs(scratch(bytes), bytes, k, v, keys.size(), 0, bits), "sort");
    if (k.Current() == keys2.data()) keys.swap(keys2);
    if (v.Current() == values2.data()) values.swap(values2);
}

// Called from kernels only; the host half exists because the kernels' source is shared.
template <class T>
GR_HD T atomic_add(T* address, T value) {
#if defined(__CUDA_ARCH__)
    using Word = std::conditional_t<sizeof(T) == 8, unsigned long long, unsigned>;
    return static_cast<T>(atomicAdd(reinterpret_cast<Word*>(address), static_cast<Word>(value)));
#else
    return *address += value, *address - value;
#endif
}
template <class T>
GR_HD void atomic_min(T* address, T value) {
#if defined(__CUDA_ARCH__)
    using Word = std::conditional_t<sizeof(T) == 8, unsigned long long, unsigned>;
    atomicMin(reinterpret_cast<Word*>(address), static_cast<Word>(value));
#else
    if (value < *address) *address = value;
#endif
}

template <class T>
GR_HD void atomic_max(T* address, T value) {
#if defined(__CUDA_ARCH__)
    using Word = std::conditional_t<sizeof(T) == 8, unsigned long long, unsigned>;
    atomicMax(reinterpret_cast<Word*>(address), static_cast<Word>(value));
#else
    if (value > *address) *address = value;
#endif
}

/// Adds each value[k] to to[k], in one go for the threads of a warp that have the same `to`. |value| < 2^42.
template <std::size_t n>
GR_HD void atomic_add_together(std::int64_t* to, const std::array<std::int64_t, n>& value) {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
    const unsigned group = __match_any_sync(__activemask(), reinterpret_cast<unsigned long long>(to));
    const bool leader = __ffs(group) - 1 == static_cast<int>(threadIdx.x % 32);
    for (std::size_t k = 0; k < n; ++k) {
        const std::uint32_t low = __reduce_add_sync(group, static_cast<std::uint32_t>(value[k]) & 0xffff);
        const std::int32_t high = __reduce_add_sync(group, static_cast<std::int32_t>(value[k] >> 16));
        if (leader) atomic_add(&to[k], std::int64_t{high} * 65536 + low);
    }
#else
    for (std::size_t k = 0; k < n; ++k) atomic_add(&to[k], value[k]);
#endif
}

inline void synchronize() { check(cudaDeviceSynchronize(), "synchronize"); }

}  // namespace grainray::cuda
