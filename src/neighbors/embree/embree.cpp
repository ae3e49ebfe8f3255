// Search by rays on the CPU. Default: a box of each point's own reach, and each point asks which boxes come within its own
// reach, so that nothing depends on the largest reach of the scene. Published: boxes of reach + largest reach, and rays of
// length 1e-16 from the points.
#include "neighbors/embree/tree.hpp"
#include "neighbors/list.hpp"

namespace grainray::cpu {
namespace {

using neighbors::Sphere;
namespace rays = neighbors::rays;

/// The boxes, and where they end: an image of a point beyond that meets nobody.
struct Boxes {
    embree::Asker asker;
    View<const Sphere> points;
    rays::Bounds bounds;
    rays::Frame frame;

    /// visit(j, shift) for every box near an image of s.
    template <class Visit>
    void near(const Sphere& s, const Visit& visit) const {
        rays::for_each_image(frame.period, [&](const Vec3i& shift) {
            const Vec3f at = rays::image({s.x, s.y, s.z}, shift, frame.period), c = frame.point(at);
            float radius = asker.by_ray ? 0 : s.reach * frame.scale;
            for (int a = 0; a < 3 && !asker.by_ray; ++a)
                radius = std::max(radius, s.reach * frame.scale + frame.pad(s.reach, at[a], frame.period[a]));
            if (shift != Vec3i{} && outside(c, radius)) return;
            asker.near(c, radius, [&](std::uint32_t j) { visit(j, shift); });
        });
    }
    bool outside(const Vec3f& c, float radius) const {
        for (int a = 0; a < 3; ++a)
            if (c[a] + radius < bounds.lower[a] || c[a] - radius > bounds.upper[a]) return true;
        return false;
    }
};

template <bool periodic>
bool near(const Sphere& a, const Vec3i& shift, const Sphere& b, const Vec3f& period) {
    if constexpr (periodic) return neighbors::pair_test(a, b, period) && rays::is_nearest(a, shift, b, period);
    else return neighbors::pair_test(a, b);
}

template <bool periodic>
struct RayPairs {
    Boxes boxes;
    View<const std::uint32_t> ids;

    std::uint32_t index(std::size_t k) const { return static_cast<std::uint32_t>(k); }
    std::uint32_t partner(std::uint32_t place) const { return place; }
    template <class Emit>
    void find(std::size_t k, const Emit& emit) const {
        const Sphere a = boxes.points[k];
        boxes.near(a, [&](std::uint32_t j, const Vec3i& shift) {
            const Sphere& b = boxes.points[j];
            emit(j, neighbors::owns(a, ids[k], b, ids[j]) & near<periodic>(a, shift, b, boxes.frame.period));
        });
    }
};

template <bool periodic>
struct RayQueries {
    Boxes boxes;
    View<const Sphere> queries;

    std::uint32_t index(std::size_t k) const { return static_cast<std::uint32_t>(k); }
    std::uint32_t partner(std::uint32_t place) const { return place; }
    template <class Emit>
    void find(std::size_t k, const Emit& emit) const {
        const Sphere a = queries[k];
        boxes.near(a, [&](std::uint32_t j, const Vec3i& shift) { emit(j, near<periodic>(a, shift, boxes.points[j], boxes.frame.period)); });
    }
};

class Embree final : public neighbors::Backend {
public:
    explicit Embree(bool published) : published_(published) {}

    void pairs(const neighbors::Packed& p, const neighbors::Request& r, NeighborList& list) override {
        const Boxes boxes = build(p, p, r);
        if (r.periodic()) build_list(RayPairs<true>{boxes, p.ids}, p.size(), Mirror(r), r, list);
        else build_list(RayPairs<false>{boxes, p.ids}, p.size(), Mirror(r), r, list);
        tree_.check();
    }
    void queries(const neighbors::Packed& q, const neighbors::Packed& p, const neighbors::Request& r, NeighborList& list) override {
        const Boxes boxes = build(q, p, r);
        if (r.periodic()) build_list(RayQueries<true>{boxes, q.spheres}, q.size(), Mirror(r), r, list);
        else build_list(RayQueries<false>{boxes, q.spheres}, q.size(), Mirror(r), r, list);
        tree_.check();
    }
    std::size_t memory_bytes() const override { return tree_.memory_bytes(); }

private:
    Boxes build(const neighbors::Packed& askers, const neighbors::Packed& p, const neighbors::Request& r) {
        const float extra = published_ ? askers.max_reach : 0, widest = p.max_reach + extra;
        const rays::Frame frame = rays::frame_of({{p.lower, p.upper}, {askers.lower, askers.upper}}, widest, r.period);
        tree_.build(p.spheres, extra, frame);
        return {{tree_.scene(), published_}, p.spheres, {frame.box(p.lower, widest).lower, frame.box(p.upper, widest).upper}, frame};
    }

    embree::Tree tree_;
    bool published_;
};

}  // namespace

neighbors::Status embree_status() { return {true, embree::version()}; }
std::unique_ptr<neighbors::Backend> make_embree() { return std::make_unique<Embree>(false); }
std::unique_ptr<neighbors::Backend> make_embree_published() { return std::make_unique<Embree>(true); }

}  // namespace grainray::cpu
