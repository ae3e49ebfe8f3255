// A plain stroke font, so that pictures need no font file.
#pragma once

#include <string_view>
#include <vector>

namespace grainray::picture {

struct Stroke {
    float x0, y0, x1, y1;
};

/// Strokes of a line of text for capitals of height 1, baseline at y = 0, y upwards. "^" raises what follows up to a blank.
struct Lettering {
    std::vector<Stroke> strokes;
    float width = 0;
};
Lettering letter(std::string_view text);

}  // namespace grainray::picture
