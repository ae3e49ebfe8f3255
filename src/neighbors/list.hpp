// From "the owner i has found j" to rows: count, scan, fill, sort. Written once for every back end; no row has a cap.
//
// A Finder is copied to the device and gives
//   index(k)        the point that work item k stands for (a locality-friendly order of the points)
//   find(k, emit)   calls emit(j, hit) for candidates j, hit where index(k) owns the pair
// and, where items may have far more candidates than others, so that CUDA lets a block of threads look at each of those,
//   some_wide       there are such items
//   wide(k)         item k is one
//   find_share(k, share, shares, emit)   the part of find(k, emit) that is thread `share`'s
#pragma once

#include "exec/exec.hpp"
#include "neighbors/backend.hpp"

namespace grainray::GRAINRAY_EXEC {

namespace rows {

/// In place, ascending. Rows are short, so insertion; a boulder's long row takes heap sort.
GR_HD inline void sort(std::uint32_t* a, std::size_t n) {
    if (n <= 48) {
        for (std::size_t i = 1; i < n; ++i) {
            const std::uint32_t v = a[i];
            std::size_t j = i;
            for (; j > 0 && a[j - 1] > v; --j) a[j] = a[j - 1];
            a[j] = v;
        }
        return;
    }
    const auto sift = [a](std::size_t root, std::size_t end) {
        for (std::size_t child; (child = 2 * root + 1) < end; root = child) {
            if (child + 1 < end && a[child] < a[child + 1]) ++child;
            if (a[root] >= a[child]) return;
            const std::uint32_t t = a[root];
            a[root] = a[child];
            a[child] = t;
        }
    };
    for (std::size_t i = n / 2; i-- > 0;) sift(i, n);
    for (std::size_t end = n; end-- > 1;) {
        const std::uint32_t t = a[0];
        a[0] = a[end];
        a[end] = t;
        sift(0, end);
    }
}

/// First pass: how much each row will hold. In the other row of a mirrored pair it is counted atomically.
template <class Finder>
struct Count {
    Finder finder;
    View<std::uint32_t> own;       ///< found by the row's own point; mirrored entries stand after them
    View<std::uint64_t> counts;
    std::uint32_t block;

    template <class Row>
    GR_HD void operator()(std::size_t k, const Row& row) const {
        const std::uint32_t i = finder.index(k);
        std::uint32_t found = 0;
        row.for_each([&](std::uint32_t j) {
            ++found;
            if (block == 1 || i / block != j / block) atomic_add(&counts[j], std::uint64_t{1});
        });
        if constexpr (!Row::shared) own[i] = found;  // else all entries of the row stand in the order in which they come
        if (found) atomic_add(&counts[i], std::uint64_t{found});
    }
};

/// Second pass.
template <class Finder>
struct Fill {
    Finder finder;
    View<const std::uint64_t> offsets;
    View<std::uint32_t> next;      ///< where the next mirrored entry of a row goes, from its start
    View<std::uint32_t> entries;
    std::uint32_t block;

    template <class Row>
    GR_HD void operator()(std::size_t k, const Row& row) const {
        const std::uint32_t i = finder.index(k);
        std::uint64_t slot = offsets[i];
        row.for_each([&](std::uint32_t j) {
            if constexpr (Row::shared) entries[slot + atomic_add(&next[i], 1u)] = j;
            else entries[slot++] = j;
            if (block == 1 || i / block != j / block) entries[offsets[j] + atomic_add(&next[j], 1u)] = i;
        });
    }
};

}  // namespace rows

/// Fills `list` with the rows of `items` work items over `n` points, as Request::kind says.
template <class Finder>
void build_list(const Finder& finder, std::size_t items, std::size_t n, const neighbors::Request& request, NeighborList& list) {
    static_assert(std::is_trivially_copyable_v<Finder>);
    // Blocks generalise the kinds: in one endless block each pair stands once, in blocks of one it stands twice.
    const std::uint32_t block = request.kind == ListKind::half ? 0xffffffffu : request.kind == ListKind::full ? 1u : request.block;
    Array<std::uint32_t> own_counts(device, n);
    own_counts.clear_bytes();
    list.offsets.resize_discard(n + 1);
    list.offsets.clear_bytes();
    const auto offsets = list.offsets.view();
    const auto own = own_counts.view();

    Found<Finder> found(finder, items);
    found.search(rows::Count<Finder>{finder, own, offsets, block});
    list.neighbors.resize_discard_slack(exclusive_scan(offsets));
    const auto entries = list.neighbors.view();
    found.again(rows::Fill<Finder>{finder, offsets, own, entries, block});
    if (request.ascending)
        for_each(n, [=] GR_HD(std::size_t i) { rows::sort(entries.data + offsets[i], offsets[i + 1] - offsets[i]); });
}

}  // namespace grainray::GRAINRAY_EXEC
