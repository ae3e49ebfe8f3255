// The order of the boxes: along the Morton curve when a tree is made, and following the ids while it is refitted, since the
// caller may store its points in another order each time.
#pragma once

#include "neighbors/backend.hpp"

namespace grainray::cuda {

class BoxOrder {
public:
    /// A new order, along the curve.
    void sort(const neighbors::Packed&);
    /// The order of the last sort for the same points where they are stored now; false where they are not the same points.
    bool follow(const neighbors::Packed&);
    /// Index of the point of each box.
    View<const std::uint32_t> order() const { return order_.view(); }
    std::size_t memory_bytes() const {
        return keys_.bytes() + keys2_.bytes() + order_.bytes() + order2_.bytes() + ids_.bytes() + place_.bytes();
    }

private:
    Array<std::uint64_t> keys_{Device::cuda}, keys2_{Device::cuda};
    Array<std::uint32_t> order_{Device::cuda}, order2_{Device::cuda};
    Array<std::uint32_t> ids_{Device::cuda};    ///< id of the point of each box
    Array<std::uint32_t> place_{Device::cuda};  ///< by id: where the point is stored
    Array<std::uint32_t> wrong_{Device::cuda, 1};
};

}  // namespace grainray::cuda
