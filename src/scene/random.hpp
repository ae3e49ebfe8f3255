// Counter-based random numbers: number n of a stream is a function of n, so that a particle's numbers depend neither on
// the order of placement, nor on other groups, nor on the standard library's distributions.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

namespace grainray::scene {

enum class Stream : std::uint64_t { jitter = 1, radius = 2, fill = 3, inlet = 4, velocity = 5 };

class Random {
public:
    Random(std::uint64_t seed, std::string_view group, Stream stream) {
        std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a
        for (const char c : group) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
        key_ = mix(mix(mix(seed + golden) ^ hash) + golden * static_cast<std::uint64_t>(stream));
    }

    /// In [0, 1), 53 bits.
    double uniform(std::uint64_t n) const { return static_cast<double>(mix(key_ + golden * (n + 1)) >> 11) * 0x1p-53; }

    /// Standard normal (Box-Muller), from the uniform numbers 2n and 2n + 1.
    double normal(std::uint64_t n) const {
        return std::sqrt(-2 * std::log(1 - uniform(2 * n))) * std::cos(2 * std::numbers::pi * uniform(2 * n + 1));
    }

private:
    static constexpr std::uint64_t golden = 0x9e3779b97f4a7c15;

    /// The output function of SplitMix64 (Steele, Lea and Flood 2014).
    static std::uint64_t mix(std::uint64_t z) {
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
        z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
        return z ^ (z >> 31);
    }

    std::uint64_t key_ = 0;
};

}  // namespace grainray::scene
