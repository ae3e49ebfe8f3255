// How the volume of a sphere divides among the cells of a grid below it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace grainray::deposit {

/// Share of a ball of radius 1 on the side t < at of a plane.
inline double ball_below(double at) {
    const double t = std::clamp(at, -1.0, 1.0);
    return 0.25 * (t + 1) * (t + 1) * (2 - t);
}

/// Share of a disc of radius 1 on the side t < at of a line.
inline double disc_below(double at) {
    const double t = std::clamp(at, -1.0, 1.0);
    return 0.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / 3.14159265358979323846;
}

/// Cells along one axis: cell k reaches from (k - 1/2) to (k + 1/2) widths past the first node.
struct CellLine {
    double first, width;
    std::int64_t cell(double at) const { return static_cast<std::int64_t>(std::floor((at - first) / width + 0.5)); }
    double lower(std::int64_t k) const { return first + (static_cast<double>(k) - 0.5) * width; }
};

/// visit(i, j, share) for every cell below a sphere; shares add up to 1. Along x they are exact; where a sphere crosses edges
/// of both kinds, its part of a column of cells is divided by slices (Gauss-Legendre, relative error below 1e-3).
template <class Visit>
void share_sphere(const CellLine& across, const CellLine& along, double x, double y, double r, const Visit& visit) {
    const std::int64_t i0 = across.cell(x - r), i1 = across.cell(x + r), j0 = along.cell(y - r), j1 = along.cell(y + r);
    if (i0 == i1) {
        for (std::int64_t j = j0; j <= j1; ++j) visit(i0, j, ball_below((along.lower(j + 1) - y) / r) - ball_below((along.lower(j) - y) / r));
        return;
    }
    constexpr double node[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
    constexpr double weight[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
    for (std::int64_t i = i0; i <= i1; ++i) {
        const double a = std::clamp((across.lower(i) - x) / r, -1.0, 1.0), b = std::clamp((across.lower(i + 1) - x) / r, -1.0, 1.0);
        const double column = ball_below(b) - ball_below(a);
        double slices = 0;
        const auto slice = [&](int k) {
            const double t = 0.5 * (a + b) + 0.5 * (b - a) * (k < 4 ? -node[3 - k] : node[k - 4]);
            const double square = std::max(1 - t * t, 1e-30);
            return std::pair{std::sqrt(square), weight[k < 4 ? 3 - k : k - 4] * square};  // radius, area
        };
        for (int k = 0; k < 8; ++k) slices += slice(k).second;
        for (std::int64_t j = j0; j <= j1; ++j) {
            double part = 0;
            for (int k = 0; k < 8; ++k) {
                const auto [radius, area] = slice(k);
                part += area * (disc_below((along.lower(j + 1) - y) / (r * radius)) - disc_below((along.lower(j) - y) / (r * radius)));
            }
            visit(i, j, column * part / slices);
        }
    }
}

}  // namespace grainray::deposit
