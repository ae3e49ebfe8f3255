// Rows of contact candidates on CUDA. The rows of 32 consecutive particles form a slice: entry k of its 32 rows lies side by
// side, so that a warp reads whole cache lines. A slice is as wide as its longest row. The upper bit of a partner says that
// the pair touched when it was last evaluated: only then does it have a history, in three planes of 32 floats.
#pragma once

#include "exec/bits.hpp"
#include "exec/cuda.hpp"
#include "state.hpp"

namespace grainray::cuda {

inline constexpr std::uint32_t slice_rows = 32, live_bit = 1u << 31;

struct Rows {
    View<const std::uint64_t> starts;   ///< of each slice, entries; multiples of 32
    View<const std::uint32_t> counts;
    View<std::uint32_t> partners;
    View<float> histories;

    explicit Rows(const ContactList& list)
        : starts(list.offsets.view()), counts(list.counts.view()),
          partners{const_cast<std::uint32_t*>(list.partners.data()), list.partners.size()},
          histories{const_cast<float*>(&list.history.data()->x), 3 * list.history.size()} {}

    GR_HD std::uint32_t size(std::size_t i) const { return counts[i]; }
    GR_HD std::uint64_t entry(std::size_t i, std::uint32_t k) const {
        return starts[i / slice_rows] + std::uint64_t{k} * slice_rows + i % slice_rows;
    }
    GR_HD std::uint32_t partner(std::uint64_t e) const { return partners[e] & ~live_bit; }
    GR_HD bool live(std::uint64_t e) const { return partners[e] & live_bit; }
    GR_HD float* plane(std::uint64_t e) const { return histories.data + 3 * (e - e % slice_rows) + e % slice_rows; }
    GR_HD Vec3f stored(std::uint64_t e) const {
        const float* h = plane(e);
        return {h[0], h[slice_rows], h[2 * slice_rows]};
    }
    GR_HD void store(std::uint64_t e, const Vec3f& v) const {
        float* h = plane(e);
        h[0] = v.x;
        h[slice_rows] = v.y;
        h[2 * slice_rows] = v.z;
    }

    GR_HD Vec3f history(std::uint64_t e) const { return live(e) ? stored(e) : Vec3f{}; }
    GR_HD void set_history(std::uint64_t e, const Vec3f& h) const {
        partners[e] |= live_bit;
        store(e, h);
    }
    GR_HD void clear_history(std::uint64_t e) const { partners[e] &= ~live_bit; }
};

/// What was found becomes slices. carry.touches(i, j), carry.history(i, j): see contacts/history.cpp. Pairs that touch lead
/// their rows, so that the contacts of a slice lie side by side.
template <class Carry>
void lay_out(NeighborList& found, const Carry& carry, ContactList& list) {
    const std::size_t n = found.rows(), slices = (n + slice_rows - 1) / slice_rows;
    if (n >= live_bit) throw InputError(std::to_string(n) + " particles: at most 2147483647 fit on the GPU");
    list.offsets.resize_discard(slices + 1);
    list.offsets.clear_bytes();
    list.counts.resize_discard(n);
    const auto offsets = found.offsets.view(), starts = list.offsets.view();
    const auto counts = list.counts.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        const auto count = static_cast<std::uint32_t>(offsets[i + 1] - offsets[i]);
        counts[i] = count;
        atomic_max(&starts[i / slice_rows], std::uint64_t{count} * slice_rows);
    });
    list.partners.resize_discard(exclusive_scan(starts));
    const auto neighbors = found.neighbors.view();
    const auto partners = list.partners.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        const std::uint32_t count = counts[i];
        const std::uint32_t* const row = neighbors.data + offsets[i];
        std::uint32_t* const first = partners.data + starts[i / slice_rows] + i % slice_rows;
        std::uint32_t front = 0, back = count;
        for (std::uint32_t start = 0; start < count; start += 32) {
            const std::uint32_t end = count - start < 32 ? count - start : 32;
            std::uint32_t touching = 0;
            for (std::uint32_t k = 0; k < end; ++k) touching |= std::uint32_t{carry.touches(i, row[start + k])} << k;
            for (std::uint32_t k = 0; k < end; ++k)
                if (touching >> k & 1) first[front++ * slice_rows] = row[start + k] | live_bit;
                else first[--back * slice_rows] = row[start + k];
        }
    });
    found.offsets.release();
    found.neighbors.release();
    list.history.resize_discard(list.partners.size());  // not before: what was found has gone
    const Rows rows(list);
    for_each(n, [=] GR_HD(std::size_t i) {
        for (std::uint32_t k = 0; k < rows.counts[i]; ++k) {
            const std::uint64_t e = rows.entry(i, k);
            if (!rows.live(e)) break;
            rows.store(e, carry.history(i, rows.partner(e)));
        }
    });
}

/// Bit k: entry start + k of row i is live.
GR_HD inline std::uint32_t live_entries(const Rows& rows, std::size_t i, std::uint32_t start) {
    const std::uint32_t* const words = rows.partners.data + rows.entry(i, start);
    const std::uint32_t left = rows.counts[i] - start, end = left < 32 ? left : 32;
    std::uint32_t live = 0;
#pragma unroll 8
    for (std::uint32_t k = 0; k < end; ++k) live |= words[k * slice_rows] >> 31 << k;
    return live;
}

/// Live entries, row after row; the list's own memory is given back.
inline void keep_live(ContactList& list, ContactList& kept) {
    const std::size_t n = list.counts.size();
    const Rows rows(list);
    kept.offsets.resize_discard(n + 1);
    kept.offsets.clear_bytes();
    const auto offsets = kept.offsets.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        std::uint64_t live = 0;
        for (std::uint32_t start = 0; start < rows.counts[i]; start += 32) live += bits_set(live_entries(rows, i, start));
        offsets[i] = live;
    });
    kept.partners.resize_discard(exclusive_scan(offsets));
    kept.history.resize_discard(kept.partners.size());
    const auto partners = kept.partners.view();
    const auto history = kept.history.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        std::uint64_t slot = offsets[i];
        for (std::uint32_t start = 0; start < rows.counts[i]; start += 32)
            for (std::uint32_t rest = live_entries(rows, i, start); rest; rest &= rest - 1) {
                const std::uint64_t e = rows.entry(i, start + lowest_bit(rest));
                partners[slot] = rows.partner(e);
                history[slot++] = rows.stored(e);
            }
    });
    list.partners.release();
    list.history.release();
}

}  // namespace grainray::cuda
