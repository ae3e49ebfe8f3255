// Hashes of 64 bits, chained.
#pragma once

#include <bit>

#include "grainray/core.hpp"

namespace grainray {

/// Finaliser of MurmurHash3 (Appleby), chained.
GR_HD inline std::uint64_t mix(std::uint64_t h, std::uint64_t value) {
    h ^= value + 0x9e3779b97f4a7c15ull;
    h = (h ^ h >> 33) * 0xff51afd7ed558ccdull;
    h = (h ^ h >> 33) * 0xc4ceb9fe1a85ec53ull;
    return h ^ h >> 33;
}
GR_HD inline std::uint64_t mix(std::uint64_t h, const Vec3f& v) {
    for (int a = 0; a < 3; ++a) h = mix(h, std::bit_cast<std::uint32_t>(v[a] + 0.0f));  // -0 and 0 are one value
    return h;
}
GR_HD inline std::uint64_t mix(std::uint64_t h, const Vec3l& v) {
    for (int a = 0; a < 3; ++a) h = mix(h, static_cast<std::uint64_t>(v[a]));
    return h;
}

}  // namespace grainray
