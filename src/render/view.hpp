// The camera: where it stands, the ray through a place of the image, the place of a point.
#pragma once

#include <optional>

#include "render/panels.hpp"
#include "render/relief.hpp"
#include "render/subject.hpp"

namespace grainray::picture {

struct Ray {
    Vec3f origin, direction;
};

/// Where a point stands in the image: pixels from the left and from the top, metres from the eye.
struct Spot {
    double x = 0, y = 0, depth = 0;
};

struct View {
    Vec3d eye, right, up, forward;  ///< relative to the subject's origin; unit vectors
    double tan_x = 1, tan_y = 1;    ///< half the width and height of the image at distance one
    int width = 0, height = 0;

    Ray ray(double x, double y) const;
    Spot spot(const Vec3d&) const;
};

/// Shares of the image to keep free of particles, for the legend and the caption.
struct Margins {
    double left = 0.04, right = 0.04, top = 0.05, bottom = 0.05;
};

/// What a picture should show.
struct Sights {
    const Subject& subject;
    const Room& room;
    const Relief* relief = nullptr;        ///< nullptr: no terrain
    const std::vector<Vec3f>& corners;     ///< of meshes
};

/// The camera of the settings, completed so that everything is in the picture; over terrain it stands on the lower side,
/// where most of the particles can be seen. Throws InputError (eye = target, ...).
View make_view(const RenderSettings&, const Sights&, const Margins&);

}  // namespace grainray::picture
