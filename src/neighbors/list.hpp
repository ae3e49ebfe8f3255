// From "the owner i has found j" to rows. Written once for every back end; no row has a cap.
//
// A Finder is copied to the device and gives
//   index(k)        the point that work item k stands for (a locality-friendly order of the points)
//   in_order()      whether index(k) is k for each k (CUDA asks)
//   find(k, emit)   calls emit(place, hit) for candidates, hit where the pair belongs to index(k)
//   partner(place)  the point of a candidate
// and, where items may have far more candidates than others, so that CUDA lets a block of threads look at each of those,
//   some_wide       there are such items
//   wide(k)         item k is one
//   find_share(k, share, shares, emit)   the part of find(k, emit) that is thread `share`'s
// A Finder may let the CPU test many points at once instead of find() (exec/runs_cpu.hpp):
//   in_runs         true; then it also has
//   owners          whether only pairs count that the item's point owns
//   wraps, period   whether there are periodic axes, and which
//   sorted.spheres, search_ids(), sorted.order   the points in the order of the search
//   sphere(k), id(k), for_each_run(k, visit)   item k's, and visit(first, last) for the places of its candidates
#pragma once

#include "exec/found.hpp"
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

}  // namespace rows

/// Whom the owner i of a pair has to tell of it: in one endless block each pair stands once, in blocks of one it stands twice.
struct Mirror {
    std::uint32_t block;
    bool some;  ///< false: nobody

    explicit Mirror(const neighbors::Request& r)
        : block(r.kind == ListKind::half ? 0xffffffffu : r.kind == ListKind::full ? 1u : r.block), some(r.kind != ListKind::half) {}
    GR_HD bool any(std::uint32_t) const { return some; }
    GR_HD bool operator()(std::uint32_t i, std::uint32_t j) const { return block == 1 || i / block != j / block; }
};

/// Fills `list` with a row for each of `items` work items; what find(k, emit) emits stands in the row of index(k) and, where
/// tells(index(k), j), in that of j.
template <class Finder, class Tells>
void build_list(const Finder& finder, std::size_t items, const Tells& tells, const neighbors::Request& request, NeighborList& list) {
    collect(finder, items, tells, request.most_entries, list);
    if (!request.ascending || list.rows() == 0) return;
    const auto offsets = list.offsets.view();
    const auto entries = list.neighbors.view();
    for_each(items, [=] GR_HD(std::size_t i) { rows::sort(entries.data + offsets[i], offsets[i + 1] - offsets[i]); });
}

}  // namespace grainray::GRAINRAY_EXEC
