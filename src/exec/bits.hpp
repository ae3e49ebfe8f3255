// Bits of a word, on every device. (In kernels std::countr_zero of this library gives 32, without a word.)
#pragma once

#include <bit>
#include <cstdint>

#include "grainray/core.hpp"

namespace grainray {

GR_HD inline std::uint32_t lowest_bit(std::uint32_t bits) {
#if defined(__CUDA_ARCH__)
    return __ffs(bits) - 1;
#else
    return static_cast<std::uint32_t>(std::countr_zero(bits));
#endif
}
GR_HD inline std::uint32_t lowest_bit(std::uint64_t bits) {
#if defined(__CUDA_ARCH__)
    return __ffsll(static_cast<long long>(bits)) - 1;
#else
    return static_cast<std::uint32_t>(std::countr_zero(bits));
#endif
}
GR_HD inline std::uint32_t bits_set(std::uint32_t bits) {
#if defined(__CUDA_ARCH__)
    return __popc(bits);
#else
    return static_cast<std::uint32_t>(std::popcount(bits));
#endif
}

}  // namespace grainray
