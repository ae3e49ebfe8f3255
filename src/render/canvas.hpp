// The picture while it is being made: display colours and the depth of what stands there.
#pragma once

#include <limits>
#include <vector>

#include "render/math.hpp"

namespace grainray::picture {

struct Canvas {
    int width, height;
    std::vector<Color> color;  ///< display values, rows from the top
    std::vector<float> depth;  ///< metres along the view direction, infinity where nothing is

    Canvas(int w, int h, const Color& background)
        : width(w), height(h), color(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), background),
          depth(color.size(), std::numeric_limits<float>::infinity()) {}

    std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
    void blend(int x, int y, const Color& c, float alpha) {
        if (x >= 0 && y >= 0 && x < width && y < height) color[at(x, y)] = mix(color[at(x, y)], c, alpha);
    }
};

}  // namespace grainray::picture
