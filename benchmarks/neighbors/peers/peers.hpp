// Other libraries' searches as contenders. Each gives a full list in one array with offsets, as ours does.
#pragma once

#include "bench_contest.hpp"

namespace grainray::peers {

/// k-d tree, CPU. The tree is built by one thread, as its version in Debian does; all threads ask it.
cli::Contender nanoflann(const cli::Cloud&);
/// Bounding volume hierarchy, on the device Kokkos was built for, points and lists on that device.
cli::Contender arborx(const cli::Cloud&);
Device arborx_device();
/// Cells, CUDA, one reach only. Takes points from host memory and puts lists there, which is in its times.
cli::Contender cunsearch(const cli::Cloud&);

}  // namespace grainray::peers
