// How the executor at hand turns "i has found j" into rows: collect(finder, items, tells, most entries, list), see neighbors/list.hpp.
#pragma once

#include "exec/exec.hpp"
#include "grainray/neighbors.hpp"

namespace grainray {

/// What becomes of a list that is too long.
inline void leave_without_rows(NeighborList& list) {
    list.offsets.resize_discard(0);
    list.neighbors.resize_discard(0);
}

}  // namespace grainray

#if defined(__CUDACC__)
#include "exec/found_cuda.hpp"
#else
#include "exec/found_cpu.hpp"
#endif
