// Which reach is common: the one that makes the boxes of the default search smallest together (boxes.hpp).
#pragma once

#include <algorithm>
#include <vector>

namespace grainray::neighbors::rays {

/// From a sample of the reaches. A common point's box has 1/2 (2 (R + c))^3, a larger one's (4 R)^3: with the largest c all
/// boxes are half boxes, with c = 0 all follow the owner rule.
inline float common_reach(std::vector<float> reaches, float largest) {
    std::sort(reaches.begin(), reaches.end());
    const std::size_t n = reaches.size(), step = std::max<std::size_t>(1, n / 64);
    double volume_of_larger = 0;  // of the points beyond the candidate
    for (const double r : reaches) volume_of_larger += 64 * r * r * r;
    double least = volume_of_larger, sums[4] = {0, 0, 0, 0};  // of R^0 .. R^3 up to the candidate
    float best = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double r = reaches[i];
        volume_of_larger -= 64 * r * r * r;
        sums[0] += 1, sums[1] += r, sums[2] += r * r, sums[3] += r * r * r;
        if (i % step != 0 && i + 1 != n) continue;
        const double c = i + 1 == n ? largest : r;
        const double volume = volume_of_larger + 4 * (sums[3] + 3 * c * sums[2] + 3 * c * c * sums[1] + c * c * c * sums[0]);
        if (volume <= least) {
            least = volume;
            best = static_cast<float>(c);
        }
    }
    return best;
}

}  // namespace grainray::neighbors::rays
