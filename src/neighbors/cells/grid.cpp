#include "neighbors/cells/grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace grainray::neighbors {
namespace {

/// The largest cap on the cells of an axis with which all together fit the budget: the longest axes wrap around.
double cap(const std::array<double, 3>& cells, double budget) {
    double low = 1, high = std::max({cells[0], cells[1], cells[2]});
    while (high - low >= 1) {
        const double middle = std::ceil(0.5 * (low + high));
        const double all = std::min(cells[0], middle) * std::min(cells[1], middle) * std::min(cells[2], middle);
        if (all <= budget) low = middle;
        else high = middle - 1;
    }
    return low;
}

}  // namespace

Grid make_grid(std::size_t points, float mean_reach, const Vec3f& lower, const Vec3f& upper, const Vec3f& box_lower, const Vec3f& period, int cut_x) {
    std::array<double, 3> extent, cells;
    double largest = 0;
    for (int a = 0; a < 3; ++a) {
        extent[a] = period[a] > 0 ? static_cast<double>(period[a]) : static_cast<double>(upper[a]) - lower[a];
        largest = std::max(largest, extent[a]);
    }
    const double budget = std::max(64.0, 2.0 * static_cast<double>(points));
    // A hair more than 2 reaches, so that 3 cells always cover a query; never so narrow that a cell index loses meaning.
    const double reaches = 2.0 * mean_reach * 1.00001, least = std::max(largest * 4e-9, 1e-30);
    std::array<double, 3> width{reaches, reaches, reaches};
    for (;; cut_x /= 2) {
        width[0] = reaches / cut_x;
        for (int a = 0; a < 3; ++a) {
            width[a] = std::max(width[a], least);
            cells[a] = period[a] > 0 ? std::max(1.0, std::floor(extent[a] / width[a])) : std::floor(extent[a] / width[a]) + 2;
        }
        if (cut_x == 1 || cells[0] * cells[1] * cells[2] <= budget) break;
    }
    const double most = cap(cells, budget);
    for (double& c : cells) c = std::min(c, most);
    const auto axis = [&](int a) {
        const bool periodic = period[a] > 0;
        return GridAxis{periodic ? box_lower[a] : lower[a], static_cast<float>(periodic ? cells[a] / extent[a] : 1.0 / width[a]),
                        static_cast<std::int32_t>(cells[a]), static_cast<float>(1 / cells[a]), periodic, periodic ? 1e-6f * period[a] : 0.0f,
                        static_cast<float>(periodic ? extent[a] / cells[a] : width[a]),
                        1e-6f * static_cast<float>(extent[a] + std::max(std::fabs(static_cast<double>(lower[a])), std::fabs(static_cast<double>(upper[a]))))};
    };
    return {axis(0), axis(1), axis(2)};
}

}  // namespace grainray::neighbors
