// Rows of what was found, on CUDA, where each item is a row's own point and tells nobody: one kernel searches and writes the
// rows where they belong. What a block finds waits in shared memory until the blocks before it have found theirs.
#pragma once

#include <cub/agent/single_pass_scan_operators.cuh>
#include <cub/block/block_scan.cuh>

#include "exec/cuda.hpp"
#include "grainray/neighbors.hpp"

namespace grainray::cuda {

inline constexpr unsigned find_threads = 128;  ///< of a block that searches

/// Puts the places of hits aside in a thread's column of shared memory, as far as there is room, and counts them.
/// The address is worked out by hand: in the loop of a search the compiler does so anew, in six instructions, for each.
template <std::uint32_t most>
class Aside {
public:
    using Room = std::uint32_t[most][find_threads];  ///< of a block
    __device__ explicit Aside(Room& room) : column_(static_cast<std::uint32_t>(__cvta_generic_to_shared(&room[0][threadIdx.x]))) {}

    __device__ void operator()(std::uint32_t place, bool hit) {
        const std::uint32_t address = column_ + found_ * find_threads * static_cast<std::uint32_t>(sizeof place);
        if (hit && found_ < most) asm volatile("st.shared.u32 [%0], %1;" ::"r"(address), "r"(place) : "memory");
        found_ += hit;
    }
    __device__ std::uint32_t found() const { return found_; }

private:
    std::uint32_t column_, found_ = 0;
};

struct Add {
    GR_HD std::uint64_t operator()(std::uint64_t a, std::uint64_t b) const { return a + b; }
};
/// How many entries the blocks before a block have found: a scan that goes on while others search (Merrill and Garland,
/// Single-pass parallel prefix scan with decoupled look-back, 2016).
using EntriesBefore = cub::ScanTileState<std::uint64_t>;

__global__ inline void clear_entries_before(EntriesBefore before, int blocks) { before.InitializeStatus(blocks); }

struct BlockEntries {
    std::uint64_t first, count;  ///< of all rows of a block
};
/// First entry of each thread's row, by how many entries it has.
__device__ inline std::uint64_t first_entry(EntriesBefore& before, std::uint32_t entries, BlockEntries& block) {
    using Scan = cub::BlockScan<std::uint64_t, find_threads>;
    using Prefix = cub::TilePrefixCallbackOp<std::uint64_t, Add, EntriesBefore>;
    __shared__ typename Scan::TempStorage scan_room;
    __shared__ typename Prefix::TempStorage prefix_room;
    __shared__ BlockEntries shared;
    std::uint64_t first = 0, all = 0;
    if (blockIdx.x == 0) {
        Scan(scan_room).ExclusiveScan(std::uint64_t{entries}, first, std::uint64_t{0}, Add{}, all);
        if (threadIdx.x == 0) {
            before.SetInclusive(0, all);
            shared = {0, all};
        }
    } else {
        Prefix prefix(before, prefix_room, Add{}, static_cast<int>(blockIdx.x));
        Scan(scan_room).ExclusiveScan(std::uint64_t{entries}, first, Add{}, prefix);
        if (threadIdx.x == 0) shared = {prefix.GetExclusivePrefix(), prefix.GetBlockAggregate()};
    }
    __syncthreads();
    block = shared;
    return first;
}

/// Points that find more than there are places for search again. Where `entries` is too small, only offsets are right.
template <class Finder>
__global__ void __launch_bounds__(find_threads) find_rows(Finder finder, std::size_t items, EntriesBefore before, std::uint64_t* offsets, View<std::uint32_t> entries) {
    constexpr std::uint32_t places = 28;
    __shared__ Aside<places>::Room columns;
    std::uint32_t* const room = &columns[0][0];
    const std::size_t k = blockIdx.x * std::size_t{find_threads} + threadIdx.x;
    Aside<places> aside(columns);
    if (k < items) finder.find(k, [&](std::uint32_t place, bool hit) { aside(place, hit); });
    const std::uint32_t found = aside.found();
    BlockEntries block;
    const std::uint64_t first = first_entry(before, found, block);
    if (k < items) offsets[k] = first;
    if (k + 1 == items) offsets[items] = first + found;
    if (block.first + block.count > entries.size) return;

    // From columns into the order of the rows, by way of registers.
    std::uint32_t own[places];
#pragma unroll
    for (std::uint32_t p = 0; p < places; ++p)
        if (p < found) own[p] = columns[p][threadIdx.x];
    __syncthreads();
    const bool fits = block.count <= places * find_threads;
    const auto put = [&](std::uint32_t at, std::uint32_t place) {
        if (fits) room[static_cast<std::uint32_t>(first - block.first) + at] = place;
        else entries[first + at] = finder.partner(place);
    };
#pragma unroll
    for (std::uint32_t p = 0; p < places; ++p)
        if (p < found) put(p, own[p]);
    if (found > places) {
        std::uint32_t seen = 0;
        finder.find(k, [&](std::uint32_t place, bool hit) {
            if (hit && seen++ >= places) put(seen - 1, place);
        });
    }
    if (!fits) return;
    __syncthreads();
    for (auto e = threadIdx.x; e < block.count; e += find_threads) entries[block.first + e] = finder.partner(room[e]);
}

/// Returns the number of entries.
template <class Finder>
std::uint64_t search_into(const Finder& finder, std::size_t items, NeighborList& list) {
    const auto blocks = static_cast<int>((items + find_threads - 1) / find_threads);
    std::size_t bytes = 0;
    check(EntriesBefore::AllocationSize(blocks, bytes), "scan");
    EntriesBefore before;
    check(before.Init(blocks, scratch(bytes), bytes), "scan");
    clear_entries_before<<<static_cast<unsigned>(blocks / find_threads + 1), find_threads>>>(before, blocks);
    find_rows<<<static_cast<unsigned>(blocks), find_threads>>>(finder, items, before, list.offsets.data(), list.neighbors.view());
    check(cudaGetLastError(), "kernel launch");
    return fetch(list.offsets.data() + items);
}

template <class Finder>
void collect_at_once(const Finder& finder, std::size_t items, std::size_t most_entries, NeighborList& list) {
    static double usual = 12;  // entries of an item, lately
    list.offsets.resize_discard(items + 1);
    if (items == 0) {
        list.offsets.clear_bytes();
        list.neighbors.resize_discard(0);
        return;
    }
    list.neighbors.resize_discard(std::min(most_entries, static_cast<std::size_t>(1.1 * usual * static_cast<double>(items)) + 64));
    const std::uint64_t entries = search_into(finder, items, list);
    if (entries > most_entries) return leave_without_rows(list);
    if (entries > list.neighbors.size()) {
        list.neighbors.resize_discard(entries);
        search_into(finder, items, list);
    }
    list.neighbors.resize_discard(entries);
    usual = static_cast<double>(entries) / static_cast<double>(items);
}

}  // namespace grainray::cuda
