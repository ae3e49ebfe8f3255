#include "neighbors/cells/grid.hpp"

#include <algorithm>
#include <array>

namespace grainray::neighbors {
namespace {

std::int32_t power_of_two_at_least(double n) {
    std::int32_t p = 1;
    while (p < n && p < (1 << 24)) p *= 2;
    return p;
}

}  // namespace

Grid make_grid(std::size_t points, float mean_reach, const Vec3f& lower, const Vec3f& upper, const Vec3f& box_lower, const Vec3f& period) {
    std::array<double, 3> extent, cells;
    double largest = 0;
    for (int a = 0; a < 3; ++a) {
        extent[a] = period[a] > 0 ? static_cast<double>(period[a]) : static_cast<double>(upper[a]) - lower[a];
        largest = std::max(largest, extent[a]);
    }
    // A hair more than 2 reaches, so that 3 cells always cover a query; never so narrow that a cell index loses meaning.
    const double width = std::max({2.0 * mean_reach * 1.00001, largest * 1e-9, 1e-30});
    for (int a = 0; a < 3; ++a)
        cells[a] = period[a] > 0 ? std::max(1.0, std::floor(extent[a] / width)) : power_of_two_at_least(extent[a] / width + 1);

    const double budget = std::max(64.0, 2.0 * static_cast<double>(points));
    while (cells[0] * cells[1] * cells[2] > budget) {
        auto& most = *std::max_element(cells.begin(), cells.end());
        if (most <= 1) break;
        most = std::floor(most / 2);
    }
    const auto axis = [&](int a) {
        const bool periodic = period[a] > 0;
        return GridAxis{periodic ? static_cast<double>(box_lower[a]) : static_cast<double>(lower[a]),
                        periodic ? cells[a] / extent[a] : 1.0 / width, static_cast<std::int32_t>(cells[a]), periodic};
    };
    return {axis(0), axis(1), axis(2)};
}

}  // namespace grainray::neighbors
