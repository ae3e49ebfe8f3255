// Forces and torques summed in 64-bit fixed point: integer addition is associative, so a sum does not depend on the order
// of its terms, hence not on threads, lists or devices (Le Grand, Goetz & Walker 2013, as in AMBER).
#pragma once

#include <bit>

#include "grainray/core.hpp"

namespace grainray {

/// One particle's sums, in quanta; a cache line, so that 8 lanes add at once.
struct alignas(64) Wrench {
    std::int64_t force[3], torque[3], unused[2];
};

/// Powers of two: multiplying by them is exact.
struct Quanta {
    double force = 1, torque = 1;  ///< N and N m a quantum

    /// 2^47 quanta to the force that overlaps the stiffest contact by the largest radius.
    static Quanta for_scale(double largest_stiffness, double largest_radius) {
        const int force = std::ilogb(largest_stiffness * largest_radius) - 47;
        return {std::ldexp(1.0, force), std::ldexp(1.0, force + std::ilogb(largest_radius))};
    }
};

inline constexpr double quantum_bound = 1125899906842624.0;  // 2^50
inline constexpr double quantum_magic = 6755399441055744.0;  // 1.5 * 2^52: added in double it rounds to an integer, 8 lanes at once

/// Nearest integer, ties to even. Values are held to +-2^50 quanta; NaN becomes the bound, so that it cannot hide in an
/// integer. inverse_quantum is a power of two, so the product is exact.
GR_HD inline std::int64_t quantize(float value, float inverse_quantum) {
    constexpr float bound = static_cast<float>(quantum_bound);
    float v = value * inverse_quantum;
    v = v < bound ? v : bound;
    v = v > -bound ? v : -bound;
    return llrintf(v);
}

}  // namespace grainray
