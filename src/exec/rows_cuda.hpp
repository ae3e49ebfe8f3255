// Rows of contact candidates on CUDA. The rows of 32 consecutive particles form a slice: entry k of its 32 rows lies side by
// side, so that a warp reads whole cache lines. A slice is as wide as its longest row. The upper bit of a partner says that
// the pair touched when it was last evaluated: only then does it have a history.
// Histories stand in columns, 32 rows wide, and a slice has fewer of them than entries: as many as its row that touches most
// needs when the list is made, and two more. Pairs that begin to touch change places with others so as to stand there
// (exec/pairs_cuda.hpp); entries beyond that touch all the same take spare columns, which all slices share.
#pragma once

#include "exec/bits.hpp"
#include "exec/cuda.hpp"
#include "state.hpp"

namespace grainray::cuda {

inline constexpr std::uint32_t slice_rows = 32, live_bit = 1u << 31;
inline constexpr std::uint32_t column_floats = 3 * slice_rows;  ///< a plane of each component
inline constexpr std::uint32_t more_columns = 2;                ///< of a slice, beyond those it needs when the list is made
inline constexpr std::size_t spares_flag = 2;                    ///< of State::flags: how many spare columns are taken
inline constexpr std::uint32_t settling_width = 64;             ///< wider slices have a column for each entry

struct Rows {
    View<const std::uint64_t> starts;   ///< of each slice, entries; multiples of 32
    View<const std::uint64_t> columns;  ///< of each slice, its own columns
    View<std::uint32_t> counts;
    View<std::uint32_t> partners;
    View<std::uint32_t> spares;         ///< of entry k of a slice, at (its start) / 32 + k: 1 + its spare column; 0: none
    float *own, *spare;                 ///< histories

    explicit Rows(const ContactList& list)
        : starts(list.offsets.view()), columns(list.columns.view()), counts(changeable(list.counts)), partners(changeable(list.partners)),
          spares(changeable(list.spares)), own(floats(list.history)), spare(floats(list.spare_history)) {}

    GR_HD std::uint32_t size(std::size_t i) const { return counts[i]; }
    /// Entry k of row i.
    GR_HD std::uint32_t& word(std::size_t i, std::uint32_t k) const {
        return partners[starts[i / slice_rows] + std::uint64_t{k} * slice_rows + i % slice_rows];
    }
    GR_HD std::uint32_t partner(std::size_t i, std::uint32_t k) const { return word(i, k) & ~live_bit; }
    GR_HD bool live(std::size_t i, std::uint32_t k) const { return word(i, k) & live_bit; }
    GR_HD std::uint32_t own_columns(std::size_t i) const {
        return static_cast<std::uint32_t>(columns[i / slice_rows + 1] - columns[i / slice_rows]);
    }
    GR_HD float* own_column(std::size_t i) const { return own + columns[i / slice_rows] * column_floats + i % slice_rows; }
    /// Where the history of a live entry is.
    GR_HD float* column(std::size_t i, std::uint32_t k) const {
        if (k < own_columns(i)) return own_column(i) + std::size_t{k} * column_floats;
        return spare + (std::uint64_t{spares[starts[i / slice_rows] / slice_rows + k]} - 1) * column_floats + i % slice_rows;
    }
    GR_HD static Vec3f stored(const float* h) { return {h[0], h[slice_rows], h[2 * slice_rows]}; }
    GR_HD static void store(float* h, const Vec3f& v) {
        h[0] = v.x;
        h[slice_rows] = v.y;
        h[2 * slice_rows] = v.z;
    }
    GR_HD Vec3f history(std::size_t i, std::uint32_t k) const { return live(i, k) ? stored(column(i, k)) : Vec3f{}; }

private:
    template <class T>
    static View<T> changeable(const Array<T>& array) { return {const_cast<T*>(array.data()), array.size()}; }
    static float* floats(const Array<Vec3f>& array) { return array.size() ? const_cast<float*>(&array.data()->x) : nullptr; }
};

inline std::uint32_t spare_columns(const ContactList& list) { return static_cast<std::uint32_t>(list.spare_history.size() / slice_rows); }

/// Spare columns from now on. Those that are taken keep what they hold.
inline void resize_spares(ContactList& list, std::size_t spares) {
    Array<Vec3f> larger(device, spares * slice_rows);
    larger.clear_bytes();  // they may be copied before every row has written its part
    const std::size_t kept = std::min(larger.size(), list.spare_history.size());
    if (kept) detail::copy(device, larger.data(), device, list.spare_history.data(), kept * sizeof(Vec3f));
    list.spare_history.swap(larger);
}

/// Where the rows of each slice start: every slice as wide as its longest row.
inline void lay_out_slices(const NeighborList& found, ContactList& list) {
    const std::size_t n = found.rows(), slices = (n + slice_rows - 1) / slice_rows;
    list.offsets.resize_discard(slices + 1);
    list.offsets.clear_bytes();
    list.counts.resize_discard(n);
    const auto offsets = found.offsets.view();
    const auto starts = list.offsets.view();
    const auto counts = list.counts.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        const auto count = static_cast<std::uint32_t>(offsets[i + 1] - offsets[i]);
        counts[i] = count;
        atomic_max_of_warp(&starts[i / slice_rows], count * slice_rows);
    });
    list.partners.resize_discard(starts_of_rows(starts));
}

/// A row of at most 64 entries into its slice, those that touch first; returns how many do. Written in the slice's order, so that the
/// lanes of a warp write side by side.
template <class Touches>
GR_HD std::uint32_t lay_out_row(const std::uint32_t* row, std::uint32_t count, const Touches& touches, std::uint32_t* first) {
    std::uint64_t touching = 0;
#pragma unroll 4
    for (std::uint32_t k = 0; k < count; ++k) touching |= std::uint64_t{touches(row[k])} << k;
    std::uint64_t apart = ~touching;
    std::uint32_t live = 0;
    for (std::uint32_t k = 0; k < count; ++k) {
        const bool touches_too = touching;
        std::uint64_t& left = touches_too ? touching : apart;
        first[k * slice_rows] = row[lowest_bit(left)] | (touches_too ? live_bit : 0);
        left &= left - 1;
        live += touches_too;
    }
    return live;
}
/// The same of a longer row.
template <class Touches>
GR_HD std::uint32_t lay_out_long_row(const std::uint32_t* row, std::uint32_t count, const Touches& touches, std::uint32_t* first) {
    std::uint32_t live = 0, back = count;
    for (std::uint32_t k = 0; k < count; ++k)
        if (touches(row[k])) first[live++ * slice_rows] = row[k] | live_bit;
        else first[--back * slice_rows] = row[k];
    return live;
}

/// Partners into their rows, those that touch first, and how many columns each slice needs.
template <class Carry>
void lay_out_partners(const NeighborList& found, const Carry& carry, ContactList& list) {
    list.columns.resize_discard(list.offsets.size());
    list.columns.clear_bytes();
    const auto offsets = found.offsets.view();
    const auto starts = list.offsets.view(), columns = list.columns.view();
    const auto neighbors = found.neighbors.view();
    const Rows rows(list);
    for_each(found.rows(), [=] GR_HD(std::size_t i) {
        const std::uint32_t count = rows.size(i), slice = static_cast<std::uint32_t>(i / slice_rows);
        const std::uint32_t* const row = neighbors.data + offsets[i];
        std::uint32_t* const first = rows.partners.data + starts[slice] + i % slice_rows;
        const auto touches = [&](std::uint32_t j) { return carry.touches(i, j); };
        const std::uint32_t live = count <= 64 ? lay_out_row(row, count, touches, first) : lay_out_long_row(row, count, touches, first);
        const auto width = static_cast<std::uint32_t>((starts[slice + 1] - starts[slice]) / slice_rows);
        const std::uint32_t needed = live + more_columns;
        atomic_max_of_warp(&columns[slice], width > settling_width || needed > width ? width : needed);
    });
}

/// What was found becomes slices. carry.touches(i, j), carry.history(i, j): see contacts/history.cpp.
template <class Carry>
void lay_out(NeighborList& found, const Carry& carry, ContactList& list) {
    const std::size_t n = found.rows();
    if (n >= live_bit) throw InputError(std::to_string(n) + " particles: at most 2147483647 fit on the GPU");
    lay_out_slices(found, list);
    lay_out_partners(found, carry, list);
    found.offsets.release();
    found.neighbors.release();
    const std::uint64_t columns = starts_of_rows(list.columns.view());
    list.history.resize_discard(columns * slice_rows);  // not before: what was found has gone
    list.spares.resize_discard(list.partners.size() / slice_rows);
    list.spares.clear_bytes();
    resize_spares(list, columns / 64 + 16);
    const Rows rows(list);
    for_each(n, [=] GR_HD(std::size_t i) {
        float* const column = rows.own_column(i);
        const std::uint32_t* const words = &rows.word(i, 0);
        const std::uint32_t size = rows.size(i);
        constexpr std::uint32_t together = 2;  // waited for together
        for (std::uint32_t k = 0; k < size && words[k * slice_rows] & live_bit; k += together) {
            Vec3f history[together];
            bool live[together];
            for (std::uint32_t t = 0; t < together; ++t) {
                const std::uint32_t word = k + t < size ? words[(k + t) * slice_rows] : 0;
                live[t] = word & live_bit;
                if (live[t]) history[t] = carry.history(i, word & ~live_bit);
            }
            for (std::uint32_t t = 0; t < together; ++t)
                if (live[t]) Rows::store(column + (k + t) * column_floats, history[t]);
        }
    });
}

/// Bit k: entry start + k of row i is live; `kept`: and of those with its particle the one that keeps their history.
struct LiveEntries {
    std::uint32_t live = 0, kept = 0;

    GR_HD LiveEntries(const Rows& rows, std::size_t i, std::uint32_t start) {
        const std::uint32_t* const words = &rows.word(i, start);
        const std::uint32_t left = rows.size(i) - start, end = left < 32 ? left : 32;
#pragma unroll 8
        for (std::uint32_t k = 0; k < end; ++k) {
            const std::uint32_t word = words[k * slice_rows];
            live |= word >> 31 << k;
            kept |= std::uint32_t{word > (static_cast<std::uint32_t>(i) | live_bit)} << k;
        }
    }
};

/// Histories of live entries, row after row, each pair in the row of its first particle, and how many live entries each row
/// had; the list's own memory is given back.
inline void keep_live(ContactList& list, ContactList& kept) {
    const std::size_t n = list.counts.size();
    const Rows rows(list);
    kept.offsets.resize_discard(n + 1);
    kept.offsets.clear_bytes();
    kept.counts.resize_discard(n);
    const auto offsets = kept.offsets.view();
    const auto counts = kept.counts.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        std::uint32_t live = 0, stays = 0;
        for (std::uint32_t start = 0; start < rows.size(i); start += 32) {
            const LiveEntries entries(rows, i, start);
            live += bits_set(entries.live);
            stays += bits_set(entries.kept);
        }
        counts[i] = live;
        offsets[i] = stays;
    });
    kept.kept.resize_discard(starts_of_rows(offsets));
    const auto pairs = kept.kept.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        constexpr std::uint32_t together = 4;  // waited for together
        const float* const own = rows.own_column(i);
        const std::uint32_t own_columns = rows.own_columns(i);
        std::uint64_t slot = offsets[i];
        for (std::uint32_t start = 0; start < rows.size(i); start += 32)
            for (std::uint32_t rest = LiveEntries(rows, i, start).kept; rest;) {
                KeptPair some[together];
                std::uint32_t count = 0;
#pragma unroll
                for (std::uint32_t t = 0; t < together; ++t) {
                    if (!rest) continue;
                    const std::uint32_t k = start + lowest_bit(rest);
                    rest &= rest - 1;
                    some[t] = {rows.partner(i, k), Rows::stored(k < own_columns ? own + k * column_floats : rows.column(i, k))};
                    count = t + 1;
                }
#pragma unroll
                for (std::uint32_t t = 0; t < together; ++t)
                    if (t < count) pairs[slot++] = some[t];
            }
    });
    list.partners.release();
    list.history.release();
    list.spares.release();
    list.spare_history.release();
}

}  // namespace grainray::cuda
