// Primitives on the CPU, over oneTBB. Every result is independent of the number of threads.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <vector>

#include "grainray/device.hpp"

namespace grainray::cpu {

inline constexpr Device device = Device::cpu;

/// f(i) for every i in [0, n), in any order.
template <class F>
void for_each(std::size_t n, const F& f, std::size_t grain = 2048) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, grain), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) f(i);
    });
}

/// The same for the stages of a step, in which each thread gets the same share every time: what it wrote is in its cache.
template <class F>
void for_each_share(std::size_t n, const F& f) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, 1), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) f(i);
    }, tbb::static_partitioner());
}

/// op over f(0) ... f(n-1); the tree of additions depends on n alone. f is called once for each i and may write what belongs to i.
template <class T, class F, class Op>
T reduce(std::size_t n, T identity, const F& f, const Op& op) {
    return tbb::parallel_deterministic_reduce(
        tbb::blocked_range<std::size_t>(0, n, 4096), identity,
        [&](const auto& range, T sum) {
            for (std::size_t i = range.begin(); i != range.end(); ++i) sum = op(sum, f(i));
            return sum;
        },
        op);
}

/// The same into *result.
template <class T, class F, class Op>
void reduce_into(T* result, std::size_t n, T identity, const F& f, const Op& op) { *result = reduce(n, identity, f, op); }

template <class T>
T fetch(const T* value) { return *value; }

/// Replaces each value by the sum of those before it; returns the sum of all.
template <class T>
T exclusive_scan(View<T> values) {
    constexpr std::size_t chunk = 1 << 15;
    const std::size_t chunks = (values.size + chunk - 1) / chunk;
    std::vector<T> start(chunks + 1, T{});
    const auto end_of = [&](std::size_t c) { return std::min(values.size, (c + 1) * chunk); };
    for_each(chunks, [&](std::size_t c) {
        for (std::size_t i = c * chunk; i < end_of(c); ++i) start[c + 1] += values[i];
    }, 1);
    for (std::size_t c = 0; c < chunks; ++c) start[c + 1] += start[c];
    for_each(chunks, [&](std::size_t c) {
        T sum = start[c];
        for (std::size_t i = c * chunk; i < end_of(c); ++i) sum += std::exchange(values[i], sum);
    }, 1);
    return start[chunks];
}
template <class T>
void sums_before(View<T> values) { exclusive_scan(values); }
/// Lengths of rows, and 0 behind the last, become their starts; returns the end of the last.
template <class T>
T starts_of_rows(View<T> lengths) { return exclusive_scan(lengths); }

/// Stable radix sort of (keys, values) by the lowest `bits` bits of the keys; `keys2`, `values2` are scratch.
template <class Key>
void sort_by_key(Array<Key>& keys, Array<std::uint32_t>& values, Array<Key>& keys2, Array<std::uint32_t>& values2, int bits) {
    constexpr int digit_bits = 11;
    constexpr std::size_t digits = std::size_t{1} << digit_bits, chunk = 1 << 16;
    const std::size_t n = keys.size(), chunks = (n + chunk - 1) / chunk;
    keys2.resize_discard(n);
    values2.resize_discard(n);
    std::vector<std::array<std::uint32_t, digits>> count(chunks);
    for (int shift = 0; shift < bits; shift += digit_bits) {
        const Key* in = keys.data();
        const auto digit = [=](std::size_t i) { return static_cast<std::size_t>(in[i] >> shift) & (digits - 1); };
        for_each(chunks, [&](std::size_t c) {
            count[c].fill(0);
            for (std::size_t i = c * chunk; i < std::min(n, (c + 1) * chunk); ++i) ++count[c][digit(i)];
        }, 1);
        std::uint32_t sum = 0;
        for (std::size_t d = 0; d < digits; ++d)
            for (std::size_t c = 0; c < chunks; ++c) sum += std::exchange(count[c][d], sum);
        for_each(chunks, [&](std::size_t c) {
            for (std::size_t i = c * chunk; i < std::min(n, (c + 1) * chunk); ++i) {
                const std::uint32_t to = count[c][digit(i)]++;
                keys2.data()[to] = keys.data()[i];
                values2.data()[to] = values.data()[i];
            }
        }, 1);
        keys.swap(keys2);
        values.swap(values2);
    }
}

/// Adds and returns what was there before.
template <class T>
T atomic_add(T* address, T value) {
    return std::atomic_ref<T>(*address).fetch_add(value, std::memory_order_relaxed);
}
template <class T>
void atomic_min(T* address, T value) {
    std::atomic_ref<T> ref(*address);
    T old = ref.load(std::memory_order_relaxed);
    while (value < old && !ref.compare_exchange_weak(old, value, std::memory_order_relaxed)) {}
}

/// Adds each value[k] to to[k].
template <std::size_t n>
void atomic_add_together(std::int64_t* to, const std::array<std::int64_t, n>& value) {
    for (std::size_t k = 0; k < n; ++k) atomic_add(&to[k], value[k]);
}

inline void synchronize() {}

}  // namespace grainray::cpu
