// Rows of what was found, on the CPU: searched once and kept by chunks of items, counted, then filled.
#pragma once

#include "exec/cpu.hpp"
#include "exec/runs_cpu.hpp"
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
            Entries kept;
            for (std::size_t k = c * chunk; k < std::min(items_, (c + 1) * chunk); ++k) {
                const std::size_t start = kept.end;
                kept.put(0, true);
                if constexpr (requires { requires Finder::in_runs; }) find_in_runs(k, kept);
                else finder_.find(k, [&](std::uint32_t place, bool hit) { kept.put(finder_.partner(place), hit); });
                kept.all[start] = static_cast<std::uint32_t>(kept.end - start - 1);
                visit(finder_.index(k), &kept.all[start] + 1, kept.all[start]);
            }
            kept_[c].assign(kept.all.begin(), kept.all.begin() + static_cast<std::ptrdiff_t>(kept.end));  // as small as it can be: all stay until the list is filled
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
    struct Entries {
        std::vector<std::uint32_t> all = std::vector<std::uint32_t>(chunk * 16);
        std::size_t end = 0;

        void make_room(std::size_t more) {
            if (end + more > all.size()) all.resize(std::max(2 * all.size(), end + more));
        }
        void put(std::uint32_t value, bool counts) {  // always written: no branch to guess
            make_room(1);
            all[end] = value;
            end += counts;
        }
    };

    static runs::Append best() {
        if constexpr (requires { requires Finder::in_runs; }) return runs::best<Finder::wraps, Finder::owners>();
        else return nullptr;
    }
    /// By runs of points, which are tested many at a time.
    void find_in_runs(std::size_t k, Entries& kept) const {
        constexpr std::size_t most = 64;
        runs::Run all[most];
        const runs::Points searched{finder_.sorted.spheres.data, finder_.search_ids().data, finder_.sorted.order.data, finder_.period};
        std::size_t count = 0, points = 0;
        const auto flush = [&] {
            kept.make_room(points + 16);
            std::uint32_t* const out = &kept.all[kept.end];
            kept.end += static_cast<std::size_t>(append_(searched, all, all + count, finder_.sphere(k), finder_.id(k), out) - out);
            count = points = 0;
        };
        finder_.for_each_run(k, [&](std::uint32_t first, std::uint32_t last) {
            if (first == last) return;
            all[count++] = {first, last};
            points += last - first;
            if (count == most) flush();
        });
        flush();
    }

    Finder finder_;
    runs::Append append_ = best();
    std::size_t items_;
    std::vector<std::vector<std::uint32_t>> kept_;  ///< of each item: how many, then which
};

template <class Finder, class Tells>
void collect(const Finder& finder, std::size_t items, const Tells& tells, std::size_t most_entries, NeighborList& list) {
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
    const std::uint64_t all = exclusive_scan(offsets);
    if (all > most_entries) return leave_without_rows(list);
    list.neighbors.resize_discard_slack(all);
    const auto entries = list.neighbors.view();
    found.again([=](std::uint32_t i, const std::uint32_t* row, std::uint32_t count) {
        for (std::uint32_t e = 0; e < count; ++e) {
            entries[offsets[i] + e] = row[e];
            if (tells(i, row[e])) entries[offsets[row[e]] + atomic_add(&next[row[e]], 1u)] = i;
        }
    });
}

}  // namespace grainray::cpu
