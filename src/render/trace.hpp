// Light: sky and one soft lamp on matte spheres and panels.
#pragma once

#include "render/canvas.hpp"
#include "render/panels.hpp"
#include "render/subject.hpp"
#include "render/view.hpp"

namespace grainray::picture {

/// The shaded picture. `colors`: linear, one a sphere; `up`: where the sky is. The same for any number of threads.
Canvas trace(const View&, const Subject&, const Room&, const std::vector<Color>& colors, const Vec3d& up);

}  // namespace grainray::picture
