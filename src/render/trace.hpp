// Light: sky and one soft lamp on matte spheres, panels and ground, and on meshes that one may look through.
#pragma once

#include <optional>

#include "render/canvas.hpp"
#include "render/panels.hpp"
#include "render/relief.hpp"
#include "render/subject.hpp"
#include "render/view.hpp"

namespace grainray::picture {

/// What is left out of the meshes: all on the side of a plane that its normal points to.
struct Cut {
    Vec3f point, normal;
};

struct Stage {
    const View& view;
    const Subject& subject;
    const Room& room;
    const Relief* relief = nullptr;
    const std::vector<Skin>& meshes;
    float mesh_opacity = 1;
    std::optional<Cut> cut;
    const std::vector<Color>& colors;  ///< linear, one a sphere
    Vec3d up;                          ///< where the sky is
};

/// The shaded picture. The same for any number of threads.
Canvas trace(const Stage&);

}  // namespace grainray::picture
