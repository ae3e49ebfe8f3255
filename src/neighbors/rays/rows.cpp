// Stage: what rays found becomes rows: repeated entries out, count, scan, fill, sort.
#include "neighbors/rays/rows.hpp"

#include "neighbors/list.hpp"

namespace grainray::GRAINRAY_EXEC {
namespace {

using neighbors::rays::Reported;
using neighbors::rays::RowsMemory;
using neighbors::rays::Slots;

/// Keeps the entries of a row that `keep(entry, places kept so far)` accepts; returns how many. place(c) is where entry c is.
template <class Place, class Keep>
GR_HD std::uint32_t filter(View<std::uint32_t> entries, std::uint32_t n, const Place& place, const Keep& keep) {
    std::uint32_t kept = 0;
    for (std::uint32_t c = 0; c < n; ++c) {
        const std::uint32_t v = entries[place(c)];
        if (!keep(v, kept)) continue;
        if (kept != c) entries[place(kept)] = v;
        ++kept;
    }
    return kept;
}

/// From one side of ray k's row: what is not near after all, and what stands there twice, since a tracer may report a box to
/// one ray more than once.
template <class Place>
GR_HD std::uint32_t clean_side(const neighbors::rays::Rows& r, std::size_t k, std::uint32_t n, bool contiguous, const Place& place) {
    const auto entries = r.slots.entries;
    if (r.doubtful[0]) n = filter(entries, n, place, [&](std::uint32_t v, std::uint32_t) { return neighbors::pair_test(r.sources[k], r.boxes[v], r.period); });
    constexpr std::uint32_t long_row = 64;
    if (n <= long_row || !contiguous)
        return filter(entries, n, place, [&](std::uint32_t v, std::uint32_t kept) {
            bool seen = false;
            for (std::uint32_t e = 0; e < kept; ++e) seen |= entries[place(e)] == v;
            return !seen;
        });
    std::uint32_t* const row = entries.data + place(0);
    rows::sort(row, n);
    return filter(entries, n, place, [&](std::uint32_t v, std::uint32_t kept) { return kept == 0 || row[kept - 1] != v; });
}

GR_HD inline void clean(const neighbors::rays::Rows& r, std::size_t k) {
    const Slots& s = r.slots;
    s.left[k] = clean_side(r, k, s.left[k], s.starts.size || s.two_sided(), [&](std::uint32_t c) { return s.from_left(k, c); });
    if (s.two_sided()) s.right[k] = clean_side(r, k, s.right[k], false, [&](std::uint32_t c) { return s.from_right(k, c); });
}

/// The rows in which a pair stands: in both across blocks, in its owner's within one. block 1: always in both.
template <bool full>
struct Standing {
    neighbors::rays::Rows rows;
    std::uint32_t block;

    GR_HD bool in_row_of(std::uint32_t i, std::uint32_t j) const {
        if constexpr (full) return true;
        return i / block != j / block || neighbors::owns(rows.points[i], rows.ids[i], rows.points[j], rows.ids[j]);
    }
    /// visit(j, place) for each point that ray k found, and its slot.
    template <class Visit>
    GR_HD void for_each(std::size_t k, const Visit& visit) const {
        const Slots& s = rows.slots;
        const auto at = [&](std::uint64_t place) { visit(rows.order[s.entries[place]], place); };
        for (std::uint32_t c = 0; c < s.left[k]; ++c) at(s.from_left(k, c));
        if (!s.two_sided()) return;
        for (std::uint32_t c = 0; c < s.right[k]; ++c) at(s.from_right(k, c));
    }
};

/// Pairs: own entries of a row first, then those that the other point of the pair found.
template <bool full>
void pair_rows(const Standing<full>& standing, bool mirror, RowsMemory& memory, NeighborList& list) {
    const std::size_t n = standing.rows.slots.rays();
    memory.own.resize_discard(n);
    memory.others.resize_discard(n);
    memory.others.clear_bytes();
    memory.ranks.resize_discard_slack(mirror ? standing.rows.slots.entries.size : 0);
    const auto own = memory.own.view(), others = memory.others.view(), ranks = memory.ranks.view();
    for_each(n, [=] GR_HD(std::size_t k) {
        clean(standing.rows, k);
        const std::uint32_t i = standing.rows.order[k];
        std::uint32_t mine = 0;
        standing.for_each(k, [&](std::uint32_t j, std::uint64_t place) {
            mine += standing.in_row_of(i, j);
            if (mirror && standing.in_row_of(j, i)) ranks[place] = atomic_add(&others[j], 1u);
        });
        own[i] = mine;
    });
    const auto offsets = list.offsets.view();
    for_each(n + 1, [=] GR_HD(std::size_t i) { offsets[i] = i < n ? std::uint64_t{own[i]} + others[i] : 0; });
    list.neighbors.resize_discard_slack(exclusive_scan(offsets));
    const auto entries = list.neighbors.view();
    for_each(n, [=] GR_HD(std::size_t k) {
        const std::uint32_t i = standing.rows.order[k];
        std::uint64_t slot = offsets[i];
        standing.for_each(k, [&](std::uint32_t j, std::uint64_t place) {
            if (standing.in_row_of(i, j)) entries[slot++] = j;
            if (mirror && standing.in_row_of(j, i)) entries[offsets[j] + own[j] + ranks[place]] = i;
        });
    });
}

void query_rows(const neighbors::rays::Rows& rows, NeighborList& list) {
    const Slots s = rows.slots;
    const std::size_t n = s.rays();
    const auto offsets = list.offsets.view();
    for_each(n + 1, [=] GR_HD(std::size_t k) {
        if (k < n) clean(rows, k);
        offsets[k] = k < n ? s.left[k] : 0;
    });
    list.neighbors.resize_discard_slack(exclusive_scan(offsets));
    const auto entries = list.neighbors.view();
    const auto order = rows.order;
    for_each(n, [=] GR_HD(std::size_t k) {
        for (std::uint32_t c = 0; c < s.left[k]; ++c) entries[offsets[k] + c] = order[s.entries[s.from_left(k, c)]];
    });
}

}  // namespace

void make_rows(const neighbors::rays::Rows& rows, Reported reported, const neighbors::Request& request, RowsMemory& memory, NeighborList& list) {
    const std::size_t n = rows.slots.rays();
    list.offsets.resize_discard(n + 1);
    const bool mirror = reported == Reported::once;
    if (reported == Reported::queries) query_rows(rows, list);
    else if (request.kind == ListKind::full || (request.kind == ListKind::blocked && request.block == 1)) pair_rows(Standing<true>{rows, 1}, mirror, memory, list);
    else pair_rows(Standing<false>{rows, request.kind == ListKind::half ? 0xffffffffu : request.block}, mirror, memory, list);
    if (!request.ascending) return;
    const auto offsets = list.offsets.view();
    const auto entries = list.neighbors.view();
    for_each(n, [=] GR_HD(std::size_t i) { rows::sort(entries.data + offsets[i], offsets[i + 1] - offsets[i]); });
}

}  // namespace grainray::GRAINRAY_EXEC
