// Stage: search by cells. Points are sorted by bucket; a query reads runs of buckets that are contiguous along x.
#include "neighbors/cells/grid.hpp"
#include "neighbors/list.hpp"

namespace grainray::GRAINRAY_EXEC {
namespace {

/// The points of one grid in bucket order.
struct Sorted {
    neighbors::Grid grid;
    View<const neighbors::Sphere> spheres;
    View<const std::uint32_t> order;   ///< index of the point at each place
    View<const std::uint32_t> starts;  ///< buckets + 1: first place of each bucket

    /// Candidates of one of `shares` threads that look at the surroundings of s together.
    template <class Test, class Emit>
    GR_HD void find_share(const neighbors::Sphere& s, float half_width, std::uint32_t share, std::uint32_t shares, const Test& test, const Emit& emit) const {
        grid.for_each_run<true>(s, half_width, share, shares, [&](std::uint32_t first, std::uint32_t last) {
            for (std::uint32_t p = starts[first], end = starts[last]; p < end; ++p) emit(order[p], test(p));
        });
    }

    template <class Test, class Emit>
    GR_HD void find(const neighbors::Sphere& s, float half_width, const Test& test, const Emit& emit) const {
        if constexpr (device == Device::cuda) return find_flat(s, half_width, test, emit);
        grid.for_each_run<device == Device::cuda>(s, half_width, [&](std::uint32_t first, std::uint32_t last) {
            for (std::uint32_t p = starts[first], end = starts[last]; p < end; ++p) emit(order[p], test(p));
        });
    }

    /// The same with one loop over the points of up to 16 runs: the lanes of a warp wait for the one with most points, not
    /// for the longest of each run.
    template <class Test, class Emit>
    GR_HD void find_flat(const neighbors::Sphere& s, float half_width, const Test& test, const Emit& emit) const {
        constexpr int most = 16;
        std::uint32_t begin[most], end[most];
        int runs = 0;
        const auto visit = [&] {
            for (int r = 0; r < runs;) {
                std::uint32_t p = begin[r], stop = end[r];
                for (;;) {
                    emit(order[p], test(p));
                    if (++p < stop) continue;
                    if (++r == runs) break;
                    p = begin[r];
                    stop = end[r];
                }
            }
            runs = 0;
        };
        grid.for_each_run<device == Device::cuda>(s, half_width, [&](std::uint32_t first, std::uint32_t last) {
            begin[runs] = starts[first];
            end[runs] = starts[last];
            runs += begin[runs] < end[runs];
            if (runs == most) visit();
        });
        visit();
    }
};

/// Mean reaches from which a point is wide: (2 * 3 + 1)^3 cells lie around it, 3^3 around most.
constexpr float wide_reach = 3;

template <bool periodic>
GR_HD inline bool near(const neighbors::Sphere& a, const neighbors::Sphere& b, const Vec3f& period) {
    if constexpr (periodic) return neighbors::pair_test(a, b, period);
    else return neighbors::pair_test(a, b);
}

template <bool periodic>
struct CellPairs {
    Sorted sorted;
    View<const std::uint32_t> sorted_ids;
    View<const neighbors::Sphere> spheres;  ///< the points in the order in which they are looked at
    View<const std::uint32_t> ids, indices; ///< no indices: the points' own order
    Vec3f period;
    float wide_from;                        ///< reach from which a point is wide
    bool some_wide;

    /// Whether the pair with the point at place p is owned.
    struct Owned {
        const CellPairs& pairs;
        neighbors::Sphere a;
        std::uint32_t id;

        GR_HD bool operator()(std::uint32_t p) const {
            const neighbors::Sphere& b = pairs.sorted.spheres[p];
            const bool hit = near<periodic>(a, b, pairs.period);
            if constexpr (device == Device::cuda) return hit && neighbors::owns(a, id, b, pairs.sorted_ids[p]);
            return hit & neighbors::owns(a, id, b, pairs.sorted_ids[p]);  // no branch: the CPU cannot guess its side
        }
    };

    GR_HD std::uint32_t index(std::size_t k) const { return indices.size ? indices[k] : static_cast<std::uint32_t>(k); }
    template <class Emit>
    GR_HD void find(std::size_t k, const Emit& emit) const {
        sorted.find(spheres[k], 2 * spheres[k].reach, Owned{*this, spheres[k], ids[k]}, emit);
    }
    GR_HD bool wide(std::size_t k) const { return spheres[k].reach > wide_from; }
    template <class Emit>
    GR_HD void find_share(std::size_t k, std::uint32_t share, std::uint32_t shares, const Emit& emit) const {
        sorted.find_share(spheres[k], 2 * spheres[k].reach, share, shares, Owned{*this, spheres[k], ids[k]}, emit);
    }
};

template <bool periodic>
struct CellQueries {
    Sorted sorted;
    View<const neighbors::Sphere> queries;
    Vec3f period;
    float max_reach;

    GR_HD std::uint32_t index(std::size_t k) const { return static_cast<std::uint32_t>(k); }
    template <class Emit>
    GR_HD void find(std::size_t k, const Emit& emit) const {
        const neighbors::Sphere q = queries[k];
        sorted.find(q, q.reach + max_reach, [&](std::uint32_t p) { return near<periodic>(q, sorted.spheres[p], period); }, emit);
    }
};

class Cells final : public neighbors::Backend {
public:
    void pairs(const neighbors::Packed& points, const neighbors::Request& r, NeighborList& list) override {
        const Sorted sorted = sort(points, r);
        if (r.periodic()) build<true>(sorted, points, r, list);
        else build<false>(sorted, points, r, list);
    }
    void queries(const neighbors::Packed& q, const neighbors::Packed& points, const neighbors::Request& r, NeighborList& list) override {
        const Sorted sorted = sort(points, r);
        const auto queries = q.spheres.view();
        if (r.periodic()) build_list(CellQueries<true>{sorted, queries, r.period, points.max_reach}, q.size(), q.size(), r, list);
        else build_list(CellQueries<false>{sorted, queries, r.period, points.max_reach}, q.size(), q.size(), r, list);
    }
    std::size_t memory_bytes() const override {
        return ranks_.bytes() + order_.bytes() + ids_.bytes() + spheres_.bytes() + starts_.bytes();
    }

    void release() override {
        for (Array<std::uint32_t>* a : {&ranks_, &order_, &ids_, &starts_}) a->release();
        spheres_.release();
    }

    Sorted sort(const neighbors::Packed& points, const neighbors::Request& r);

private:
    template <bool periodic>
    void build(const Sorted& sorted, const neighbors::Packed& points, const neighbors::Request& r, NeighborList& list) {
        const float wide_from = wide_reach * points.mean_reach;
        const bool some_wide = points.max_reach > wide_from;
        const auto finder = r.local_order
                                ? CellPairs<periodic>{sorted, ids_.view(), points.spheres.view(), points.ids.view(), {}, r.period, wide_from, some_wide}
                                : CellPairs<periodic>{sorted, ids_.view(), spheres_.view(), ids_.view(), order_.view(), r.period, wide_from, some_wide};
        build_list(finder, points.size(), points.size(), r, list);
    }

    Array<std::uint32_t> ranks_{device}, order_{device}, ids_{device}, starts_{device};
    Array<neighbors::Sphere> spheres_{device};
};

/// A counting sort: how many lie in each bucket, where each bucket starts, and each point to its place.
Sorted Cells::sort(const neighbors::Packed& points, const neighbors::Request& r) {
    const std::size_t n = points.size();
    const neighbors::Grid grid = neighbors::make_grid(n, points.mean_reach, points.lower, points.upper, r.lower, r.period);
    ranks_.resize_discard(n);
    order_.resize_discard(n);
    spheres_.resize_discard(n);
    ids_.resize_discard(n);
    starts_.resize_discard_slack(grid.buckets() + 1);
    starts_.clear_bytes();
    const auto in = points.spheres.view();
    const auto in_ids = points.ids.view();
    const auto spheres = spheres_.view();
    const auto ranks = ranks_.view(), order = order_.view(), ids = ids_.view(), starts = starts_.view();
    for_each(n, [=] GR_HD(std::size_t i) { ranks[i] = atomic_add(&starts[grid.bucket(in[i])], 1u); });
    exclusive_scan(starts);
    for_each(n, [=] GR_HD(std::size_t i) {
        const std::uint32_t p = starts[grid.bucket(in[i])] + ranks[i];
        spheres[p] = in[i];
        ids[p] = in_ids[i];
        order[p] = static_cast<std::uint32_t>(i);
    });
    return {grid, spheres, order, starts};
}

}  // namespace

std::unique_ptr<neighbors::Backend> make_cells() { return std::make_unique<Cells>(); }

}  // namespace grainray::GRAINRAY_EXEC
