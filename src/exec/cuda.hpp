// Primitives on one CUDA device, over CUB. Same contracts as exec/cpu.hpp.
#pragma once

#include <cub/block/block_reduce.cuh>
#include <cub/block/block_scan.cuh>
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>

#include <algorithm>
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

/// Waits for the device.
inline void synchronize() { check(cudaStreamSynchronize(nullptr), "synchronize"); }

/// What the device has been given so far: wait() returns when that is done, whatever it has been given since.
class SoFar {
public:
    SoFar() { check(cudaEventRecord(event(), nullptr), "event"); }
    void wait() const { check(cudaEventSynchronize(event()), "event"); }

private:
    static cudaEvent_t event() {
        static const cudaEvent_t only = [] {
            cudaEvent_t made;
            check(cudaEventCreateWithFlags(&made, cudaEventDisableTiming), "event");
            return made;
        }();
        return only;
    }
};

/// Where kernels put a result that the host reads after synchronize(): memory of the host, so that no copy is waited for.
template <class T>
T* landing() {
    static T* const place = [] {
        void* p = nullptr;
        check(cudaMallocHost(&p, sizeof(T)), "host memory");
        return static_cast<T*>(p);
    }();
    return place;
}

/// Waits for the device and reads one value from it.
template <class T>
T fetch(const T* value) {
    T* const place = landing<T>();
    for_each(1, [=] GR_HD(std::size_t) { *place = *value; });
    synchronize();
    return *place;
}

inline constexpr unsigned reduce_threads = 256;

/// Blocks leave their parts; the last of them to finish joins these. `finished` counts them and is 0 again afterwards.
template <class T, class F, class Op>
__global__ void __launch_bounds__(reduce_threads) reduce_kernel(std::size_t n, T identity, F f, Op op, T* parts, std::uint32_t* finished, T* result) {
    using Block = cub::BlockReduce<T, reduce_threads>;
    __shared__ typename Block::TempStorage room;
    __shared__ bool last;
    T sum = identity;
    for (std::size_t i = blockIdx.x * std::size_t{reduce_threads} + threadIdx.x; i < n; i += std::size_t{gridDim.x} * reduce_threads) sum = op(sum, f(i));
    sum = Block(room).Reduce(sum, op);
    if (threadIdx.x == 0) {
        parts[blockIdx.x] = sum;
        __threadfence();
        last = atomicInc(finished, gridDim.x - 1) == gridDim.x - 1;
    }
    __syncthreads();
    if (!last) return;
    sum = identity;
    for (unsigned b = threadIdx.x; b < gridDim.x; b += reduce_threads) sum = op(sum, parts[b]);
    sum = Block(room).Reduce(sum, op);
    if (threadIdx.x == 0) *result = sum;
}

/// *result, which a kernel can reach, becomes op over f(0) ... f(n-1). f is called once for each i and may write what belongs to i.
/// The order of additions depends on n alone.
template <class T, class F, class Op>
void reduce_into(T* result, std::size_t n, T identity, const F& f, const Op& op) {
    static Array<std::uint32_t> finished(Device::cuda, std::vector<std::uint32_t>{0});
    // A block has four items a thread, fewer where blocks would be too few to fill a GPU, more where they would be very many.
    constexpr std::size_t many = 1024, most = 4096;
    const std::size_t all = n / reduce_threads + 1;
    const auto blocks = static_cast<unsigned>(std::min(all, std::clamp(all / 4, many, most)));
    T* const parts = static_cast<T*>(scratch(blocks * sizeof(T)));
    reduce_kernel<<<blocks, reduce_threads>>>(n, identity, f, op, parts, finished.data(), result);
    check(cudaGetLastError(), "kernel launch");
}

template <class T, class F, class Op>
T reduce(std::size_t n, T identity, const F& f, const Op& op) {
    reduce_into(landing<T>(), n, identity, f, op);
    synchronize();
    return *landing<T>();
}

/// Replaces each value by the sum of those before it.
template <class T>
void sums_before(View<T> values) {
    std::size_t bytes = 0;
    check(cub::DeviceScan::ExclusiveSum(nullptr, bytes, values.data, values.data, values.size), "scan");
    check(cub::DeviceScan::ExclusiveSum(scratch(bytes), bytes, values.data, values.data, values.size), "scan");
}

/// The same; waits, and returns the sum of all.
template <class T>
T exclusive_scan(View<T> values) {
    if (values.size == 0) return T{};
    static Array<T> last_value(Device::cuda, 1);
    T *const last = last_value.data(), *const total = landing<T>();
    const T* const end = values.end() - 1;
    for_each(1, [=] GR_HD(std::size_t) { *last = *end; });
    sums_before(values);
    for_each(1, [=] GR_HD(std::size_t) { *total = *last + *end; });
    synchronize();
    return *total;
}

constexpr unsigned start_threads = 1024, start_items = 8;

template <class T>
__global__ void __launch_bounds__(start_threads) starts_kernel(T* lengths, std::size_t n, T* end) {
    using Scan = cub::BlockScan<T, start_threads>;
    __shared__ typename Scan::TempStorage room;
    T items[start_items];
    for (unsigned k = 0; k < start_items; ++k) items[k] = threadIdx.x * start_items + k < n ? lengths[threadIdx.x * start_items + k] : T{};
    T sum;
    Scan(room).ExclusiveSum(items, items, sum);
    for (unsigned k = 0; k < start_items; ++k)
        if (threadIdx.x * start_items + k < n) lengths[threadIdx.x * start_items + k] = items[k];
    if (threadIdx.x == 0) *end = sum;
}

/// Lengths of rows, and 0 behind the last, become their starts. Waits, and returns the end of the last. One launch where rows are few.
template <class T>
T starts_of_rows(View<T> lengths) {
    if (lengths.size == 0) return T{};
    if (lengths.size > start_threads * start_items) {
        sums_before(lengths);
        return fetch(lengths.end() - 1);
    }
    starts_kernel<<<1, start_threads>>>(lengths.data, lengths.size, landing<T>());
    check(cudaGetLastError(), "kernel launch");
    synchronize();
    return *landing<T>();
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

/// The same for the threads of a warp that are active, which all give one address, in one go.
GR_HD inline void atomic_max_of_warp(std::uint64_t* address, std::uint32_t value) {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
    const unsigned active = __activemask(), largest = __reduce_max_sync(active, value);
    if (__ffs(active) - 1 == static_cast<int>(threadIdx.x % 32)) atomic_max(address, std::uint64_t{largest});
#else
    atomic_max(address, std::uint64_t{value});
#endif
}

/// Adds each value[k] to to[k], in one go for the threads of a warp that have the same `to`. |value| < 2^42.
template <std::size_t n>
GR_HD void atomic_add_together(std::int64_t* to, const std::array<std::int64_t, n>& value) {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
    const unsigned active = __activemask(), group = __match_any_sync(active, reinterpret_cast<unsigned long long>(to));
    const bool leader = __ffs(group) - 1 == static_cast<int>(threadIdx.x % 32);
    constexpr std::int64_t small = 1 << 26;  // the sum of 32 fits 32 bits
    bool wide = false;
    for (std::size_t k = 0; k < n; ++k) wide |= value[k] >= small || value[k] < -small;
    if (!__any_sync(active, wide)) {
        for (std::size_t k = 0; k < n; ++k) {
            const std::int32_t sum = __reduce_add_sync(group, static_cast<std::int32_t>(value[k]));
            if (leader) atomic_add(&to[k], std::int64_t{sum});
        }
        return;
    }
    for (std::size_t k = 0; k < n; ++k) {
        const std::uint32_t low = __reduce_add_sync(group, static_cast<std::uint32_t>(value[k]) & 0xffff);
        const std::int32_t high = __reduce_add_sync(group, static_cast<std::int32_t>(value[k] >> 16));
        if (leader) atomic_add(&to[k], std::int64_t{high} * 65536 + low);
    }
#else
    for (std::size_t k = 0; k < n; ++k) atomic_add(&to[k], value[k]);
#endif
}

}  // namespace grainray::cuda
