// Rows of what was found, on CUDA: a table takes up to `places` entries of each row as they are found, so that one search is
// enough; what finds no place there is left over and joins its row when the list is filled.
#pragma once

#include "exec/found_once_cuda.hpp"

namespace grainray::cuda {

/// An entry of a row.
struct LeftOver {
    std::uint32_t row_plus_one;  ///< 0: none
    std::uint32_t entry;
};

struct Table {
    static constexpr std::uint32_t places = 28;
    View<std::uint32_t> entries;     ///< place p of row i at p * rows + i
    View<std::uint8_t> own;          ///< entries of a row that its own point found; they stand first
    View<std::uint32_t> counts;      ///< entries of a row, with those of other points that found no place
    View<LeftOver> left_over;
    std::uint64_t* left_over_count;  ///< more than there is room for: all of it must be done again

    GR_HD std::uint32_t& at(std::size_t row, std::uint32_t place) const { return entries[place * counts.size + row]; }
    GR_HD std::uint32_t held(std::size_t row) const { return counts[row] < places ? counts[row] : places; }
    GR_HD void leave(std::uint64_t slot, std::uint32_t row, std::uint32_t entry) const {
        if (slot < left_over.size) left_over[slot] = {row + 1, entry};
    }
};

/// What one thread leaves over. It takes room for 16 at a time: one counter that all add to one by one would be waited for.
struct LeftOvers {
    const Table& table;
    std::uint64_t slot = 0, end = 0;

    GR_HD void add(std::uint32_t row, std::uint32_t entry) {
        constexpr std::uint64_t room = 16;
        if (slot == end) {
            slot = atomic_add(table.left_over_count, room);
            end = slot + room;
        }
        table.leave(slot++, row, entry);
    }
    /// The room that is left holds nothing.
    GR_HD void close() {
        for (; slot < end; ++slot)
            if (slot < table.left_over.size) table.left_over[slot] = {};
    }
    template <class Finder, class Tells>
    GR_HD void add_found(const Finder& finder, std::uint32_t i, std::uint32_t place, const Tells& tells) {
        const std::uint32_t j = finder.partner(place);
        add(i, j);
        if (tells(i, j)) add(j, i);
    }
};

template <class Finder>
constexpr bool knows_wide = requires(const Finder& f) { f.wide(std::size_t{}); };

template <class Finder>
GR_HD bool is_wide([[maybe_unused]] const Finder& finder, [[maybe_unused]] std::size_t k) {
    if constexpr (knows_wide<Finder>) return finder.some_wide && finder.wide(k);
    else return false;
}

/// What the items find, in their own rows, and what a row has no places for left over; those who find more than can be put aside
/// search again for the rest. Put aside are places of partners: to look up each partner when it is found would be waited for in the
/// search's loop.
template <class Finder, class Tells>
__global__ void __launch_bounds__(find_threads) find_own_kernel(Finder finder, std::size_t items, Tells tells, Table table) {
    constexpr std::uint32_t most = 40;
    __shared__ Aside<most>::Room columns;
    const std::size_t k = blockIdx.x * std::size_t{find_threads} + threadIdx.x;
    if (k >= items) return;
    Aside<most> aside(columns);
    if (!is_wide(finder, k)) finder.find(k, [&](std::uint32_t place, bool hit) { aside(place, hit); });
    const std::uint32_t i = finder.index(k), found = aside.found(), own = min(found, Table::places);
#pragma unroll 4
    for (std::uint32_t p = 0; p < own; ++p) table.at(i, p) = finder.partner(columns[p][threadIdx.x]);
    table.own[i] = static_cast<std::uint8_t>(own);
    table.counts[i] = own;
    if (found == own) return;
    LeftOvers rest{table};
    for (std::uint32_t p = own; p < min(found, most); ++p) rest.add_found(finder, i, columns[p][threadIdx.x], tells);
    std::uint32_t seen = 0;
    if (found > most)
        finder.find(k, [&](std::uint32_t place, bool hit) {
            if (hit && seen++ >= most) rest.add_found(finder, i, place, tells);
        });
    rest.close();
}

template <class Finder, class Tells>
void find_own(const Finder& finder, std::size_t items, const Tells& tells, const Table& table) {
    if (items == 0) return;
    find_own_kernel<<<static_cast<unsigned>((items + find_threads - 1) / find_threads), find_threads>>>(finder, items, tells, table);
    check(cudaGetLastError(), "kernel launch");
}

/// Wide items are looked at by many threads, which leave all over.
template <class Finder, class Tells>
void find_wide(const Finder& finder, std::size_t items, const Tells& tells, const Table& table) {
    Array<std::uint32_t> listed(device, items + 1);  // how many items are wide, then which
    const auto wide = listed.view();
    for_each(1, [=] GR_HD(std::size_t) { wide[0] = 0; });
    for_each(items, [=] GR_HD(std::size_t k) {
        if (finder.wide(k)) wide[1 + atomic_add(&wide[0], 1u)] = static_cast<std::uint32_t>(k);
    });
    for_each_in_blocks(wide.data, [=] GR_HD(std::size_t w, std::uint32_t share, std::uint32_t shares) {
        const std::uint32_t k = wide[1 + w], i = finder.index(k);
        LeftOvers rest{table};
        finder.find_share(k, share, shares, [&](std::uint32_t place, bool hit) { if (hit) rest.add_found(finder, i, place, tells); });
        rest.close();
    });
}

/// Each row's own entries into the rows of the others, after theirs. Four at a time, so that they wait for memory together.
/// tells.any(i): there may be somebody whom i tells.
template <class Tells>
void tell_others(const Tells& tells, const Table& table) {
    constexpr std::uint32_t together = 4;
    for_each(table.counts.size, [=] GR_HD(std::size_t k) {
        const auto i = static_cast<std::uint32_t>(k);
        const std::uint32_t own = tells.any(i) ? table.own[i] : 0;
        for (std::uint32_t first = 0; first < own; first += together) {
            std::uint32_t row[together], place[together];
            for (std::uint32_t t = 0; t < together; ++t) {
                row[t] = first + t < own ? table.at(i, first + t) : i;
                if (row[t] != i && !tells(i, row[t])) row[t] = i;  // no point is its own neighbour
                if (row[t] != i) place[t] = atomic_add(&table.counts[row[t]], 1u);
            }
            for (std::uint32_t t = 0; t < together; ++t) {
                if (row[t] == i) continue;
                if (place[t] < Table::places) table.at(row[t], place[t]) = i;
                else table.leave(atomic_add(table.left_over_count, std::uint64_t{1}), row[t], i);
            }
        }
    });
}

template <class Visit>
void for_each_left_over(const Table& table, const Visit& visit) {
    for_each(table.left_over.size, [=] GR_HD(std::size_t s) {
        if (s < *table.left_over_count && table.left_over[s].row_plus_one) visit(table.left_over[s].row_plus_one - 1, table.left_over[s].entry);
    });
}

/// How much the table and what it left over come to: entries, without those for which there was no room, and the room that was
/// taken, part of which holds nothing.
struct ListSizes {
    std::uint64_t entries, left_over;
    GR_HD bool fit(const Table& table, const View<std::uint32_t>& list) const { return entries <= list.size && left_over <= table.left_over.size; }
};

/// The places of a block's rows, put in order in shared memory where they fit, so that they are written side by side; what stands
/// between them then is overwritten by what was left over.
template <unsigned rows>
__global__ void fill_from_places(Table table, const std::uint64_t* offsets, View<std::uint32_t> entries) {
    constexpr unsigned room = rows * Table::places;
    __shared__ std::uint32_t ordered[room];
    const std::size_t n = table.counts.size, first = std::size_t{blockIdx.x} * rows, i = first + threadIdx.x;
    if (!ListSizes{offsets[n], *table.left_over_count}.fit(table, entries)) return;
    const std::uint32_t held = i < n ? table.held(i) : 0;
    const std::uint64_t start = offsets[min(i, n)], begin = offsets[first], end = offsets[min(first + rows, n)];
    const bool fits = end - begin <= room;
    std::uint32_t* const row = fits ? ordered + (start - begin) : entries.data + start;
    for (std::uint32_t p = 0; p < held; ++p) row[p] = table.at(i, p);
    if (i < n) table.counts[i] = held;
    if (!fits) return;
    __syncthreads();
    for (std::uint64_t e = threadIdx.x; e < end - begin; e += rows) entries[begin + e] = ordered[e];
}

/// Nothing happens where there is no room for all.
inline void fill_rows(const Table& table, View<const std::uint64_t> offsets, View<std::uint32_t> entries) {
    const std::size_t n = table.counts.size;
    if (n == 0) return;
    constexpr unsigned together = 128;
    fill_from_places<together><<<static_cast<unsigned>((n + together - 1) / together), together>>>(table, offsets.data, entries);
    check(cudaGetLastError(), "kernel launch");
    for_each_left_over(table, [=] GR_HD(std::uint32_t row, std::uint32_t entry) {
        if (ListSizes{offsets[n], *table.left_over_count}.fit(table, entries)) entries[offsets[row] + atomic_add(&table.counts[row], 1u)] = entry;
    });
}

/// The table and what it left over become rows, at once where there is room for as many entries as expected. Returns their sizes;
/// where more was left over than there is room for or there are too many, nothing is done.
inline ListSizes make_rows(const Table& table, std::size_t expected, std::size_t most_entries, NeighborList& list) {
    const std::size_t n = table.counts.size;
    list.offsets.resize_discard(n + 1);
    const auto offsets = list.offsets.view();
    for_each(n + 1, [=] GR_HD(std::size_t i) { offsets[i] = i < n ? table.held(i) : 0; });
    for_each_left_over(table, [=] GR_HD(std::uint32_t row, std::uint32_t) { atomic_add(&offsets[row], std::uint64_t{1}); });
    sums_before(offsets);
    ListSizes* const sizes = landing<ListSizes>();
    for_each(1, [=] GR_HD(std::size_t) { *sizes = {offsets[n], *table.left_over_count}; });
    const SoFar counted;
    list.neighbors.resize_discard(expected);
    fill_rows(table, offsets, list.neighbors.view());
    counted.wait();
    if (sizes->left_over > table.left_over.size || sizes->entries > most_entries) return *sizes;
    const bool filled = sizes->entries <= expected;
    list.neighbors.resize_discard_slack(sizes->entries);
    if (!filled) fill_rows(table, offsets, list.neighbors.view());
    return *sizes;
}

template <class Finder, class Tells>
void collect(const Finder& finder, std::size_t items, const Tells& tells, std::size_t most_entries, NeighborList& list) {
    static_assert(std::is_trivially_copyable_v<Finder>);
    bool some_wide = false;
    if constexpr (knows_wide<Finder>) some_wide = finder.some_wide;
    if (finder.in_order() && !tells.some && !some_wide) return collect_at_once(finder, items, most_entries, list);
    static double usual = 0, usual_entries = 0;  // left over of an item, lately, and found for it
    Array<std::uint32_t> entries(device, items * Table::places), counts(device, items);
    Array<std::uint8_t> own(device, items);
    Array<std::uint64_t> left_over_count(device, 1);
    for (auto room = static_cast<std::size_t>((0.2 + 1.5 * usual) * static_cast<double>(items)) + 1024;;) {
        Array<LeftOver> left_over(device, room);
        left_over_count.clear_bytes();
        const Table table{entries.view(), own.view(), counts.view(), left_over.view(), left_over_count.data()};
        find_own(finder, items, tells, table);
        if constexpr (knows_wide<Finder>)
            if (some_wide) find_wide(finder, items, tells, table);
        if (tells.some) tell_others(tells, table);
        const auto expected = static_cast<std::size_t>(std::min<double>(1.1 * usual_entries, Table::places) * static_cast<double>(items));
        const ListSizes sizes = make_rows(table, std::min(expected, most_entries), most_entries, list);
        if (sizes.entries > most_entries) return leave_without_rows(list);
        if (items) {
            usual = std::max(0.9 * usual, static_cast<double>(sizes.left_over) / static_cast<double>(items));
            usual_entries = static_cast<double>(sizes.entries) / static_cast<double>(items);
        }
        if (sizes.left_over <= room) return;
        room = sizes.left_over;
    }
}

}  // namespace grainray::cuda
