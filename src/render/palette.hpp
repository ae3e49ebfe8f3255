// Colours of numbers and of kinds.
#pragma once

#include <cstddef>

#include "render/math.hpp"

namespace grainray::picture {

/// Perceptually uniform scale from violet to yellow, t clamped to 0..1. Display values.
Color scale_color(float t);

/// Colour of the kind k; kinds beyond the palette start over. Display values.
Color kind_color(std::size_t k);
std::size_t kind_colors();

}  // namespace grainray::picture
