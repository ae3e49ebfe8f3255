// Stage: how much a search by cells would look at, without searching.
#include "exec/exec.hpp"
#include "neighbors/backend.hpp"
#include "neighbors/cells/grid.hpp"

namespace grainray::GRAINRAY_EXEC {
namespace {

using neighbors::Effort;

struct Looks {
    double sum, most;
};
struct Join {
    GR_HD Looks operator()(const Looks& a, const Looks& b) const { return {a.sum + b.sum, a.most > b.most ? a.most : b.most}; }
};

}  // namespace

Effort cells_effort(const neighbors::Packed& asking, const neighbors::Packed& points, bool of_queries, const neighbors::Request& r) {
    if (asking.size() == 0 || points.size() == 0) return {};
    const neighbors::Grid grid = neighbors::make_grid(points.size(), points.mean_reach, points.lower, points.upper, r.lower, r.period, neighbors::search_cut_x);
    Array<std::uint32_t> starts(device, grid.buckets() + 1);
    starts.clear_bytes();
    const auto start = starts.view();
    const auto spheres = points.spheres, from = asking.spheres;
    for_each(points.size(), [=] GR_HD(std::size_t i) { atomic_add(&start[grid.bucket(spheres[i])], 1u); });
    sums_before(start);
    const float largest = points.max_reach;
    const Looks all = reduce(asking.size(), Looks{0, 0}, [=] GR_HD(std::size_t i) {
        const float width = from[i].reach + (of_queries ? largest : from[i].reach);
        double looks = 0;
        grid.for_each_run<device == Device::cuda>(from[i], width, [&](std::uint32_t first, std::uint32_t last) { looks += start[last] - start[first]; });
        return Looks{looks, looks};
    }, Join{});
    return {all.sum / static_cast<double>(asking.size()), all.most};
}

}  // namespace grainray::GRAINRAY_EXEC
