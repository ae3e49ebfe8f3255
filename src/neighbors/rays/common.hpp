// Which reaches are small and common: those with which rays meet the fewest boxes (boxes.hpp).
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace grainray::neighbors::rays {

struct Limits {
    float small, common;
};

namespace detail {

/// Sums over ascending reaches from one on: of R^0 .. R^3.
class Moments {
public:
    explicit Moments(const std::vector<float>& ascending) : sums_(ascending.size() + 1) {
        for (std::size_t i = ascending.size(); i-- > 0;) {
            sums_[i] = sums_[i + 1];
            double power = 1;
            for (double& s : sums_[i].of) s += power, power *= ascending[i];
        }
    }
    std::size_t size() const { return sums_.size() - 1; }
    double count(std::size_t first, std::size_t end) const { return sums_[first].of[0] - sums_[end].of[0]; }
    double cubes(std::size_t first, std::size_t end) const { return sums_[first].of[3] - sums_[end].of[3]; }
    /// Sum of (R + c)^3.
    double cubes_with(double c, std::size_t first, std::size_t end) const {
        const auto m = [&](int k) { return sums_[first].of[k] - sums_[end].of[k]; };
        return m(3) + 3 * c * m(2) + 3 * c * c * m(1) + c * c * c * m(0);
    }

private:
    struct Powers {
        double of[4] = {0, 0, 0, 0};
    };
    std::vector<Powers> sums_;
};

}  // namespace detail

/// From a sample of the reaches. Rays meet boxes in proportion to their volume; a further box costs a refit what meeting
/// three does a ray, and at ten neighbours a point meets nine at the least.
inline Limits limits(std::vector<float> reaches, float largest) {
    std::sort(reaches.begin(), reaches.end());
    const detail::Moments m(reaches);
    const std::size_t n = m.size(), step = std::max<std::size_t>(1, n / 32);
    const auto reach = [&](std::size_t i) { return i + 1 >= n ? largest : reaches[i]; };  // of the last up to i, the largest of all included
    double least = 1e300, equal = 0;
    for (const float r : reaches) equal += 32.0 * r * r * r;
    Limits best{largest, largest};
    for (std::size_t s = 0; s < n; s = s + step < n || s + 1 == n ? s + step : n - 1) {  // the small: up to s
        const double c = reach(s);
        const double for_small = m.count(0, s + 1) * (4 * m.cubes_with(c, 0, s + 1) + 8 * m.cubes_with(c, s + 1, n));
        double for_larger = 64 * m.cubes(s + 1, n);
        float common = static_cast<float>(c);  // none
        for (std::size_t k = s + 1; k < n; k = k + step < n || k + 1 == n ? k + step : n - 1) {
            const double volume = 4 * m.cubes_with(reach(k), s + 1, k + 1) + 64 * m.cubes(k + 1, n);
            if (volume <= for_larger) for_larger = volume, common = reach(k);
        }
        const double larger = m.count(s + 1, n);
        const double cost = for_small + larger * for_larger + larger * equal / 3;
        if (cost <= least) least = cost, best = {static_cast<float>(c), common};
    }
    return best;
}

}  // namespace grainray::neighbors::rays
