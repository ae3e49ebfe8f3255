// Where rays write what they find: a row of slots a ray, filled from the left and, where rows are two-sided, from the right.
#pragma once

#include <cstdint>

#include "grainray/device.hpp"

namespace grainray::neighbors::rays {

struct Slots {
    View<std::uint32_t> entries;
    View<std::uint32_t> left;            ///< of each ray: entries from the left, counted on past the row's end
    View<std::uint32_t> right;           ///< the same from the right; empty: one-sided
    View<const std::uint64_t> starts;    ///< rays + 1 places, once the counts are known; empty: `width` slots a ray
    std::uint32_t width = 0;

    GR_HD std::size_t rays() const { return left.size; }
    GR_HD bool two_sided() const { return right.size != 0; }
    GR_HD std::uint32_t found(std::size_t k) const { return left[k] + (two_sided() ? right[k] : 0); }
    GR_HD std::uint64_t room(std::size_t k) const { return starts.size ? starts[k + 1] - starts[k] : width; }

    // One-sided rows of fixed width are interleaved, so that the rays of a warp write side by side.
    GR_HD std::uint64_t from_left(std::size_t k, std::uint32_t c) const {
        if (starts.size) return starts[k] + c;
        return two_sided() ? static_cast<std::uint64_t>(k) * width + c : static_cast<std::uint64_t>(c) * rays() + k;
    }
    GR_HD std::uint64_t from_right(std::size_t k, std::uint32_t c) const {
        return (starts.size ? starts[k + 1] : static_cast<std::uint64_t>(k + 1) * width) - 1 - c;
    }
};

}  // namespace grainray::neighbors::rays
