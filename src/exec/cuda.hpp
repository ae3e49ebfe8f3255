// Primitives on one CUDA device, over CUB. Same contracts as exec/cpu.hpp.
#pragma once

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_reduce.cuh>
#include <cub/device/device_scan.cuh>
#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>

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

/// Scratch memory of the primitives, kept from call to call.
inline void* scratch(std::size_t bytes) {
    static Array<char> memory(Device::cuda);
    memory.resize_discard_slack(bytes ? bytes : 1);
    return memory.data();
}

template <class T, class F, class Op>
T reduce(std::size_t n, T identity, const F& f, const Op& op) {
    static Array<T> result(Device::cuda, 1);
    const auto values = thrust::make_transform_iterator(thrust::counting_iterator<std::size_t>(0), f);
    std::size_t bytes = 0;
    check(cub::DeviceReduce::Reduce(nullptr, bytes, values, result.data(), n, op, identity), "reduce");
    check(cub::DeviceReduce::Reduce(scratch(bytes), bytes, values, result.data(), n, op, identity), "reduce");
    return result.to_host()[0];
}

template <class T>
T exclusive_scan(View<T> values) {
    if (values.size == 0) return T{};
    T last{}, start{};
    check(cudaMemcpy(&last, values.end() - 1, sizeof(T), cudaMemcpyDeviceToHost), "scan");
    std::size_t bytes = 0;
    check(cub::DeviceScan::ExclusiveSum(nullptr, bytes, values.data, values.data, values.size), "scan");
    check(cub::DeviceScan::ExclusiveSum(scratch(bytes), bytes, values.data, values.data, values.size), "scan");
    check(cudaMemcpy(&start, values.end() - 1, sizeof(T), cudaMemcpyDeviceToHost), "scan");
    return start + last;
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

/// What each work item of a Finder (neighbors/list.hpp) finds, twice: searching again costs less than keeping it would.
template <class Finder>
class Found {
public:
    struct Row {
        Finder finder;
        std::size_t k;
        template <class Emit>
        GR_HD void for_each(const Emit& emit) const {
            finder.find(k, [&](std::uint32_t j, bool hit) {
                if (hit) emit(j);
            });
        }
    };

    Found(const Finder& finder, std::size_t items) : finder_(finder), items_(items) {}
    template <class Visit>
    void search(const Visit& visit) {
        const Finder finder = finder_;
        cuda::for_each(items_, [=] GR_HD(std::size_t k) { visit(k, Row{finder, k}); });
    }
    template <class Visit>
    void again(const Visit& visit) { search(visit); }

private:
    Finder finder_;
    std::size_t items_;
};

inline void synchronize() { check(cudaDeviceSynchronize(), "synchronize"); }

}  // namespace grainray::cuda
