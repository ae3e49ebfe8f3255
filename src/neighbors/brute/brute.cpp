// Stage: all pairs, N^2 tests. The oracle of the tests, and the fastest for a few hundred points.
#include "neighbors/list.hpp"

namespace grainray::GRAINRAY_EXEC {
namespace {

struct BrutePairs {
    View<const neighbors::Sphere> points;
    View<const std::uint32_t> ids;
    Vec3f period;

    GR_HD std::uint32_t partner(std::uint32_t place) const { return place; }
    GR_HD std::uint32_t index(std::size_t k) const { return static_cast<std::uint32_t>(k); }
    static bool in_order() { return true; }
    template <class Emit>
    GR_HD void find(std::size_t k, const Emit& emit) const {
        const neighbors::Sphere a = points[k];
        for (std::size_t j = 0; j < points.size; ++j)
            emit(static_cast<std::uint32_t>(j), neighbors::owns(a, ids[k], points[j], ids[j]) & neighbors::pair_test(a, points[j], period));
    }
};

struct BruteQueries {
    View<const neighbors::Sphere> queries, points;
    Vec3f period;

    GR_HD std::uint32_t partner(std::uint32_t place) const { return place; }
    GR_HD std::uint32_t index(std::size_t k) const { return static_cast<std::uint32_t>(k); }
    static bool in_order() { return true; }
    template <class Emit>
    GR_HD void find(std::size_t k, const Emit& emit) const {
        for (std::size_t j = 0; j < points.size; ++j)
            emit(static_cast<std::uint32_t>(j), neighbors::pair_test(queries[k], points[j], period));
    }
};

class Brute final : public neighbors::Backend {
public:
    void pairs(const neighbors::Packed& p, const neighbors::Request& r, NeighborList& list) override {
        build_list(BrutePairs{p.spheres, p.ids, r.period}, p.size(), Mirror(r), r, list);
    }
    void queries(const neighbors::Packed& q, const neighbors::Packed& p, const neighbors::Request& r, NeighborList& list) override {
        build_list(BruteQueries{q.spheres, p.spheres, r.period}, q.size(), Mirror(r), r, list);
    }
    std::size_t memory_bytes() const override { return 0; }
};

}  // namespace

std::unique_ptr<neighbors::Backend> make_brute() { return std::make_unique<Brute>(); }

}  // namespace grainray::GRAINRAY_EXEC
