// Morton (Z-order) codes: points that are near in space are mostly near in storage.
#pragma once

#include "grainray/core.hpp"

namespace grainray::neighbors {

/// Spreads the low 21 bits so that two zero bits follow each.
GR_HD inline std::uint64_t spread(std::uint64_t v) {
    v &= 0x1fffff;
    v = (v | v << 32) & 0x1f00000000ffffull;
    v = (v | v << 16) & 0x1f0000ff0000ffull;
    v = (v | v << 8) & 0x100f00f00f00f00full;
    v = (v | v << 4) & 0x10c30c30c30c30c3ull;
    v = (v | v << 2) & 0x1249249249249249ull;
    return v;
}
GR_HD inline std::uint64_t morton(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
    return spread(x) | spread(y) << 1 | spread(z) << 2;
}

}  // namespace grainray::neighbors
