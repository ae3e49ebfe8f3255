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

    /// emit(place, hit) for the candidates of one of `shares` threads that look at the surroundings of s together. test(point, its place).
    template <class Test, class Emit>
    GR_HD void find_share(const neighbors::Sphere& s, float half_width, std::uint32_t share, std::uint32_t shares, const Test& test, const Emit& emit) const {
        grid.for_each_run<true>(s, half_width, share, shares, [&](std::uint32_t first, std::uint32_t last) {
            for (std::uint32_t p = starts[first], end = starts[last]; p < end; ++p) emit(p, test(spheres[p], p));
        });
    }

    /// visit(first place, past the last)
    template <class Visit>
    GR_HD void for_each_run(const neighbors::Sphere& s, float half_width, const Visit& visit) const {
        grid.for_each_run<device == Device::cuda>(s, half_width, [&](std::uint32_t first, std::uint32_t last) { visit(starts[first], starts[last]); });
    }
    /// `together` points at a time, so that they are waited for together.
    template <std::uint32_t together, class Test, class Emit>
    GR_HD void find(const neighbors::Sphere& s, float half_width, const Test& test, const Emit& emit) const {
        for_each_run(s, half_width, [&](std::uint32_t first, std::uint32_t end) {
            for (std::uint32_t p = first; p < end; p += together) {
                std::uint32_t at[together];
                neighbors::Sphere some[together];
                for (std::uint32_t t = 0; t < together; ++t) at[t] = t == 0 || p + t < end ? p + t : end - 1;
                for (std::uint32_t t = 0; t < together; ++t) some[t] = spheres[at[t]];
                for (std::uint32_t t = 0; t < together; ++t) emit(at[t], (at[t] == p + t) & test(some[t], at[t]));
            }
        });
    }
};

/// Mean reaches from which a point is wide: (2 * 3 + 1)^3 cells lie around it, 3^3 around most.
constexpr float wide_reach = 3;

template <bool periodic>
GR_HD inline bool near(const neighbors::Sphere& a, const neighbors::Sphere& b, const Vec3f& period) {
    if constexpr (periodic) return neighbors::pair_test(a, b, period);
    else return neighbors::pair_test(a, b);
}

/// Mean reaches up to which points see each other. Wider than 1 where few are much larger: what sees more need not be told.
constexpr float common_reach = 1.1f;

/// Where rows are full, CUDA lets both points of a pair find it where their reaches are about equal: to find twice costs less
/// than to tell the other. A point sees those of no larger reach, of up to `common`, and up to a quarter larger; of two, the one with the
/// larger reach sees the other.
struct Sight {
    float common;

    GR_HD float limit(float reach) const { return neighbors::larger(reach, neighbors::smaller(common, 1.25f * reach)); }
    GR_HD bool sees(const neighbors::Sphere& a, const neighbors::Sphere& b) const { return b.reach <= limit(a.reach); }
};

/// Whom point i has to tell of the pair.
struct Unseeing {
    View<const neighbors::Sphere> spheres;
    Sight sight;
    float seen_by_all;  ///< reach up to which every point sees a point
    bool some;

    GR_HD bool any(std::uint32_t i) const { return spheres[i].reach > seen_by_all; }
    GR_HD bool operator()(std::uint32_t i, std::uint32_t j) const { return !sight.sees(spheres[j], spheres[i]); }
};

/// What a point takes for its row: pairs that it owns or, `seen`, all that it sees.
template <bool periodic, bool seen>
struct CellPairs {
    Sorted sorted;
    View<const std::uint32_t> sorted_ids;
    View<const neighbors::Sphere> spheres;  ///< the points in the order in which they are looked at
    View<const std::uint32_t> ids, indices; ///< no indices: the points' own order
    View<const std::uint32_t> places;       ///< of the points in their own order
    Vec3f period;
    Sight sight;
    float wide_from;                        ///< reach from which a point is wide
    bool some_wide;

    struct Taken {
        const CellPairs& pairs;
        neighbors::Sphere a;
        std::uint32_t id, place;
        float limit;

        GR_HD bool operator()(const neighbors::Sphere& b, std::uint32_t p) const {
            const bool hit = near<periodic>(a, b, pairs.period);
            if constexpr (seen) return hit & (b.reach <= limit) & (p != place);
            else return hit && neighbors::owns(a, id, b, pairs.sorted_ids[p]);
        }
    };

    GR_HD std::uint32_t partner(std::uint32_t place) const { return sorted.order[place]; }
    GR_HD Taken taken(std::size_t k) const {
        const neighbors::Sphere& a = spheres[k];
        return {*this, a, seen ? 0 : ids[k], indices.size ? static_cast<std::uint32_t>(k) : places[k], seen ? sight.limit(a.reach) : a.reach};
    }
    GR_HD std::uint32_t index(std::size_t k) const { return indices.size ? indices[k] : static_cast<std::uint32_t>(k); }
    bool in_order() const { return indices.size == 0; }
    template <class Emit>
    GR_HD void find(std::size_t k, const Emit& emit) const {
        const Taken t = taken(k);
        sorted.template find<seen ? 4 : 2>(t.a, t.a.reach + t.limit, t, emit);  // fewer where each is asked for its owner
    }
    static constexpr bool in_runs = !seen, wraps = periodic, owners = true;
    GR_HD View<const std::uint32_t> search_ids() const { return sorted_ids; }
    GR_HD const neighbors::Sphere& sphere(std::size_t k) const { return spheres[k]; }
    GR_HD std::uint32_t id(std::size_t k) const { return ids[k]; }
    template <class Visit>
    GR_HD void for_each_run(std::size_t k, const Visit& visit) const {
        sorted.for_each_run(spheres[k], 2 * spheres[k].reach, visit);
    }
    GR_HD bool wide(std::size_t k) const { return spheres[k].reach > wide_from; }
    template <class Emit>
    GR_HD void find_share(std::size_t k, std::uint32_t share, std::uint32_t shares, const Emit& emit) const {
        const Taken t = taken(k);
        sorted.find_share(t.a, t.a.reach + t.limit, share, shares, t, emit);
    }
};

template <bool periodic>
struct CellQueries {
    Sorted sorted;
    View<const neighbors::Sphere> queries;
    Vec3f period;
    float max_reach;

    static constexpr bool in_runs = true, wraps = periodic, owners = false;
    GR_HD View<const std::uint32_t> search_ids() const { return {}; }
    GR_HD const neighbors::Sphere& sphere(std::size_t k) const { return queries[k]; }
    GR_HD std::uint32_t id(std::size_t) const { return 0; }
    template <class Visit>
    GR_HD void for_each_run(std::size_t k, const Visit& visit) const {
        sorted.for_each_run(queries[k], queries[k].reach + max_reach, visit);
    }
    GR_HD std::uint32_t partner(std::uint32_t place) const { return sorted.order[place]; }
    GR_HD std::uint32_t index(std::size_t k) const { return static_cast<std::uint32_t>(k); }
    static bool in_order() { return true; }
    template <class Emit>
    GR_HD void find(std::size_t k, const Emit& emit) const {
        const neighbors::Sphere q = queries[k];
        sorted.template find<4>(q, q.reach + max_reach, [&](const neighbors::Sphere& b, std::uint32_t) { return near<periodic>(q, b, period); }, emit);
    }
};

class Cells final : public neighbors::Backend {
public:
    void pairs(const neighbors::Packed& points, const neighbors::Request& r, NeighborList& list) override {
        const bool seen = device == Device::cuda && full(r);
        const Sorted sorted = sort(points, r, !seen, seen ? 0.5f * (points.mean_reach + sight_of(points).common) : points.mean_reach);
        if (r.periodic()) build<true>(sorted, points, r, list);
        else build<false>(sorted, points, r, list);
    }
    void queries(const neighbors::Packed& q, const neighbors::Packed& points, const neighbors::Request& r, NeighborList& list) override {
        const Sorted sorted = sort(points, r, false, points.mean_reach);
        const auto queries = q.spheres;
        if (r.periodic()) build_list(CellQueries<true>{sorted, queries, r.period, points.max_reach}, q.size(), Mirror(r), r, list);
        else build_list(CellQueries<false>{sorted, queries, r.period, points.max_reach}, q.size(), Mirror(r), r, list);
    }
    std::size_t memory_bytes() const override {
        return ranks_.bytes() + order_.bytes() + ids_.bytes() + spheres_.bytes() + starts_.bytes();
    }

    void release() override {
        for (Array<std::uint32_t>* a : {&ranks_, &order_, &ids_, &starts_}) a->release();
        spheres_.release();
    }

    /// owners: pairs are taken by the owner rule, which asks for the ids. usual: half of how far a point of mean reach looks.
    Sorted sort(const neighbors::Packed& points, const neighbors::Request& r, bool owners, float usual);

private:
    static Sight sight_of(const neighbors::Packed& points) { return {neighbors::smaller(common_reach * points.mean_reach, points.max_reach)}; }
    static bool full(const neighbors::Request& r) { return r.kind == ListKind::full || (r.kind == ListKind::blocked && r.block == 1); }
    template <bool periodic>
    void build(const Sorted& sorted, const neighbors::Packed& points, const neighbors::Request& r, NeighborList& list) {
        const Sight sight = sight_of(points);
        if constexpr (device == Device::cuda)
            if (full(r)) {
                const float seen_by_all = sight.limit(points.min_reach);
                return build_list(finder<periodic, true>(sorted, points, r, sight), points.size(),
                                  Unseeing{points.spheres, sight, seen_by_all, points.max_reach > seen_by_all}, r, list);
            }
        build_list(finder<periodic, false>(sorted, points, r, sight), points.size(), Mirror(r), r, list);
    }
    template <bool periodic, bool seen>
    CellPairs<periodic, seen> finder(const Sorted& sorted, const neighbors::Packed& points, const neighbors::Request& r, const Sight& sight) const {
        const float wide_from = wide_reach * points.mean_reach;
        const bool some_wide = points.max_reach > wide_from;
        if (r.local_order) return {sorted, ids_.view(), points.spheres, points.ids, {}, ranks_.view(), r.period, sight, wide_from, some_wide};
        return {sorted, ids_.view(), spheres_.view(), ids_.view(), order_.view(), ranks_.view(), r.period, sight, wide_from, some_wide};
    }

    Array<std::uint32_t> ranks_{device}, order_{device}, ids_{device}, starts_{device};
    Array<neighbors::Sphere> spheres_{device};
};

/// A counting sort: how many lie in each bucket, where each bucket starts, and each point to its place.
Sorted Cells::sort(const neighbors::Packed& points, const neighbors::Request& r, bool owners, float usual) {
    const std::size_t n = points.size();
    const neighbors::Grid grid = neighbors::make_grid(n, usual, points.lower, points.upper, r.lower, r.period, neighbors::search_cut_x);
    starts_.resize_discard_slack(grid.buckets() + 1);
    starts_.clear_bytes();
    ranks_.resize_discard(n);
    const auto in = points.spheres;
    const auto in_ids = points.ids;
    const auto ranks = ranks_.view(), starts = starts_.view();
    for_each(n, [=] GR_HD(std::size_t i) { ranks[i] = atomic_add(&starts[grid.bucket(in[i])], 1u); });
    sums_before(starts);

    order_.resize_discard(n);
    spheres_.resize_discard(n);
    ids_.resize_discard(owners ? n : 0);
    const auto spheres = spheres_.view();
    const auto order = order_.view(), ids = ids_.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        const std::uint32_t p = starts[grid.bucket(in[i])] + ranks[i];
        order[p] = static_cast<std::uint32_t>(i);
        ranks[i] = p;
    });
    for_each(n, [=] GR_HD(std::size_t p) {
        const std::uint32_t i = order[p];
        spheres[p] = in[i];
        if (owners) ids[p] = in_ids[i];
    });
    return {grid, spheres, order, starts};
}

}  // namespace

std::unique_ptr<neighbors::Backend> make_cells() { return std::make_unique<Cells>(); }

}  // namespace grainray::GRAINRAY_EXEC
