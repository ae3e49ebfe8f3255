// The acceleration structure over the boxes of the points.
#pragma once

#include "neighbors/optix/machine.hpp"

namespace grainray::optix {

class BoxTree {
public:
    Array<OptixAabb>& boxes() { return boxes_; }
    /// From the boxes; `refit` keeps the tree of the last build, which must have had as many boxes.
    void build(bool refit);
    OptixTraversableHandle handle() const { return handle_; }
    std::size_t memory_bytes() const { return boxes_.bytes() + tree_.bytes() + scratch_.bytes(); }

private:
    void compact();

    Array<OptixAabb> boxes_{Device::cuda};
    Array<char> tree_{Device::cuda}, scratch_{Device::cuda};
    Array<std::uint64_t> compacted_size_{Device::cuda, 1};
    OptixTraversableHandle handle_ = 0;
};

}  // namespace grainray::optix
