// The points that have a second box in a tree of differing reaches (rays/boxes.hpp). For CUDA sources.
#pragma once

#include "exec/exec.hpp"
#include "neighbors/pair_test.hpp"

namespace grainray::cuda {

struct LargerOf {
    GR_HD float operator()(float a, float b) const { return a > b ? a : b; }
};

/// The points that are larger than small ones when a tree is built, and stay so while it is refitted.
class LargerPoints {
public:
    void choose(View<const neighbors::Sphere> spheres, float small) {
        const std::size_t n = spheres.size;
        places_.resize_discard(n + 1);
        const auto places = places_.view();
        for_each(n + 1, [=] GR_HD(std::size_t p) { places[p] = p < n && spheres[p].reach > small; });
        points_.resize_discard(exclusive_scan(places));
        const auto points = points_.view();
        for_each(n, [=] GR_HD(std::size_t p) {
            if (places[p + 1] != places[p]) points[places[p]] = static_cast<std::uint32_t>(p);
        });
    }
    /// The largest reach among the others.
    float largest_small(View<const neighbors::Sphere> spheres) const {
        const auto places = places_.view();
        return reduce(spheres.size, 0.0f, [=] GR_HD(std::size_t p) { return places[p + 1] == places[p] ? spheres[p].reach : 0.0f; }, LargerOf{});
    }
    View<const std::uint32_t> points() const { return points_.view(); }
    std::size_t memory_bytes() const { return places_.bytes() + points_.bytes(); }

private:
    Array<std::uint32_t> places_{device};  ///< how many stand before each point
    Array<std::uint32_t> points_{device};
};

}  // namespace grainray::cuda
