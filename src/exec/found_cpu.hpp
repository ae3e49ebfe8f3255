// Rows of what was found, on the CPU: searched once and kept by chunks of items, counted, then filled.
#pragma once

#include "exec/cpu.hpp"
#include "grainray/neighbors.hpp"

namespace grainray::cpu {

/// What each work item finds.
template <class Finder>
class Found {
public:
    Found(const Finder& finder, std::size_t items) : finder_(finder), items_(items), kept_((items + chunk - 1) / chunk) {}

    /// Searches, and calls visit(i, entries, count) for every item.
    template <class Visit>
    void search(const Visit& visit) {
        for_each(kept_.size(), [&](std::size_t c) {
            std::vector<std::uint32_t> kept(chunk * 16);
            std::size_t end = 0;
            const auto put = [&](std::uint32_t value, bool counts) {  // always written: no branch to guess
                if (end == kept.size()) kept.resize(2 * end);
                kept[end] = value;
                end += counts;
            };
            for (std::size_t k = c * chunk; k < std::min(items_, (c + 1) * chunk); ++k) {
                const std::size_t start = end;
                put(0, true);
                finder_.find(k, [&](std::uint32_t place, bool hit) { put(finder_.partner(place), hit); });
                kept[start] = static_cast<std::uint32_t>(end - start - 1);
                visit(finder_.index(k), &kept[start] + 1, kept[start]);
            }
            kept_[c].assign(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(end));  // as small as it can be: all stay until the list is filled
        }, 1);
    }
    /// The same calls again.
    template <class Visit>
    void again(const Visit& visit) const {
        for_each(kept_.size(), [&](std::size_t c) {
            const std::uint32_t* row = kept_[c].data();
            for (std::size_t k = c * chunk; k < std::min(items_, (c + 1) * chunk); ++k, row += *row + 1) visit(finder_.index(k), row + 1, *row);
        }, 1);
    }

private:
    static constexpr std::size_t chunk = 256;
    Finder finder_;
    std::size_t items_;
    std::vector<std::vector<std::uint32_t>> kept_;  ///< of each item: how many, then which
};

template <class Finder, class Tells>
void collect(const Finder& finder, std::size_t items, const Tells& tells, NeighborList& list) {
    Array<std::uint32_t> own_counts(device, items);  // found by the row's own point; mirrored entries stand after them
    list.offsets.resize_discard(items + 1);
    list.offsets.clear_bytes();
    const auto offsets = list.offsets.view();
    const auto next = own_counts.view();

    Found<Finder> found(finder, items);
    found.search([=](std::uint32_t i, const std::uint32_t* row, std::uint32_t count) {
        for (std::uint32_t e = 0; e < count; ++e)
            if (tells(i, row[e])) atomic_add(&offsets[row[e]], std::uint64_t{1});
        next[i] = count;
        if (count) atomic_add(&offsets[i], std::uint64_t{count});
    });
    list.neighbors.resize_discard_slack(exclusive_scan(offsets));
    const auto entries = list.neighbors.view();
    found.again([=](std::uint32_t i, const std::uint32_t* row, std::uint32_t count) {
        for (std::uint32_t e = 0; e < count; ++e) {
            entries[offsets[i] + e] = row[e];
            if (tells(i, row[e])) entries[offsets[row[e]] + atomic_add(&next[row[e]], 1u)] = i;
        }
    });
}

}  // namespace grainray::cpu
