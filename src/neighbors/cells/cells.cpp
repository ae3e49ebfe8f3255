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

    template <class Test, class Emit>
    GR_HD void find(const neighbors::Sphere& s, float half_width, const Test& test, const Emit& emit) const {
        grid.for_each_run(s, half_width, [&](std::uint32_t first, std::uint32_t last) {
            for (std::uint32_t p = starts[first], end = starts[last]; p < end; ++p)
                emit(order[p], test(p));
        });
    }
};

template <bool periodic>
GR_HD inline bool near(const neighbors::Sphere& a, const neighbors::Sphere& b, const Vec3f& period) {
    if constexpr (periodic) return neighbors::pair_test(a, b, period);
    else return neighbors::pair_test(a, b);
}

template <bool periodic>
struct CellPairs {
    Sorted sorted;
    View<const std::uint32_t> ids;  ///< by place
    Vec3f period;

    GR_HD std::uint32_t index(std::size_t k) const { return sorted.order[k]; }
    template <class Emit>
    GR_HD void find(std::size_t k, const Emit& emit) const {
        const neighbors::Sphere a = sorted.spheres[k];
        const std::uint32_t id = ids[k];
        sorted.find(a, 2 * a.reach, [&](std::uint32_t p) {
            const neighbors::Sphere& b = sorted.spheres[p];
            return near<periodic>(a, b, period) & neighbors::owns(a, id, b, ids[p]);
        }, emit);
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
        if (r.periodic()) build_list(CellPairs<true>{sorted, ids_.view(), r.period}, points.size(), points.size(), r, list);
        else build_list(CellPairs<false>{sorted, ids_.view(), r.period}, points.size(), points.size(), r, list);
    }
    void queries(const neighbors::Packed& q, const neighbors::Packed& points, const neighbors::Request& r, NeighborList& list) override {
        const Sorted sorted = sort(points, r);
        const auto queries = q.spheres.view();
        if (r.periodic()) build_list(CellQueries<true>{sorted, queries, r.period, points.max_reach}, q.size(), q.size(), r, list);
        else build_list(CellQueries<false>{sorted, queries, r.period, points.max_reach}, q.size(), q.size(), r, list);
    }
    std::size_t memory_bytes() const override {
        return keys_.bytes() * 2 + order_.bytes() * 2 + ids_.bytes() + spheres_.bytes() + starts_.bytes();
    }

    Sorted sort(const neighbors::Packed& points, const neighbors::Request& r);

private:
    Array<std::uint32_t> keys_{device}, keys2_{device}, order_{device}, order2_{device}, ids_{device}, starts_{device};
    Array<neighbors::Sphere> spheres_{device};
};

Sorted Cells::sort(const neighbors::Packed& points, const neighbors::Request& r) {
    const std::size_t n = points.size();
    const neighbors::Grid grid = neighbors::make_grid(n, points.mean_reach, points.lower, points.upper, r.lower, r.period);
    const std::uint32_t buckets = grid.buckets();
    keys_.resize_discard(n);
    order_.resize_discard(n);
    const auto in = points.spheres.view();
    {
        const auto keys = keys_.view();
        const auto order = order_.view();
        for_each(n, [=] GR_HD(std::size_t i) {
            keys[i] = grid.bucket(in[i]);
            order[i] = static_cast<std::uint32_t>(i);
        });
    }
    int bits = 1;
    while (bits < 32 && (buckets - 1) >> bits) ++bits;
    sort_by_key(keys_, order_, keys2_, order2_, bits);

    spheres_.resize_discard(n);
    ids_.resize_discard(n);
    starts_.resize_discard_slack(buckets + 1);
    const auto keys = keys_.view();
    const auto order = order_.view();
    const auto spheres = spheres_.view();
    const auto ids = ids_.view(), starts = starts_.view();
    const auto in_ids = points.ids.view();
    for_each(n, [=] GR_HD(std::size_t p) {
        spheres[p] = in[order[p]];
        ids[p] = in_ids[order[p]];
        // This place opens its own bucket and every empty one before it; the last place closes the table.
        for (std::uint32_t b = p == 0 ? 0 : keys[p - 1] + 1; b <= keys[p]; ++b) starts[b] = static_cast<std::uint32_t>(p);
        if (p + 1 == n)
            for (std::uint32_t b = keys[p] + 1; b <= buckets; ++b) starts[b] = static_cast<std::uint32_t>(n);
    });
    if (n == 0) starts_.clear_bytes();
    return {grid, spheres, order, starts};
}

}  // namespace

std::unique_ptr<neighbors::Backend> make_cells() { return std::make_unique<Cells>(); }

}  // namespace grainray::GRAINRAY_EXEC
