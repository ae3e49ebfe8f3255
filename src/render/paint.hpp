// Which colour each sphere has, and what the legend must say about it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/math.hpp"
#include "render/subject.hpp"
#include "render/surroundings.hpp"

namespace grainray::picture {

/// The numbers of a colour bar.
struct Scale {
    double low = 0, high = 1;
    bool below = false, above = false;  ///< some values lie beyond that end and have its colour
};

struct Kind {
    std::string name;
    Color color;  ///< display values
};

struct Paint {
    std::string title, unit;
    std::vector<Color> colors;   ///< linear, one a sphere
    std::optional<Scale> scale;  ///< of a quantity
    std::vector<Kind> kinds;     ///< of a category
};

/// `shared`: the scale to use instead of the frame's own. Throws InputError: unknown color_by, a field the frame lacks,
/// color_minimum not below color_maximum.
Paint make_paint(const Frame&, const Scene&, const RenderSettings&, const Subject&, const Surroundings&, const std::optional<Scale>& shared);

/// A scale that holds both.
Scale joined(const Scale&, const Scale&);

/// The least distance of tick marks (1, 2 or 5 times a power of ten) that cuts the range into at most six.
double tick_step(double low, double high);

}  // namespace grainray::picture
