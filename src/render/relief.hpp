// The terrain about the subject, cut out as a block: its surface, its sides, and what colour the ground has.
#pragma once

#include "grainray/surfaces.hpp"
#include "render/skin.hpp"
#include "render/subject.hpp"

namespace grainray::picture {

/// Everything but `ground` relative to the subject's origin.
struct Relief {
    const ElevationGrid* ground;
    Vec3d origin;               ///< of the subject
    Skin surface, sides;
    Box box;
    double interval = 0;        ///< of the contour lines, m
    float line = 0;             ///< half their width on the map, m

    /// Linear colour of the surface at a place.
    Color color(const Vec3f& at, const Vec3f& normal) const;
    /// Of the cut sides.
    Color side_color(const Vec3f& at) const;
    /// Is the straight way between two points over the ground, within the block?
    bool sees(const Vec3d& from, const Vec3d& to) const;
    /// The direction in which water would run, on average below the spheres; zero on the level.
    Vec3d downhill(const Subject&) const;
};

Relief make_relief(const ElevationGrid&, const Subject&);

}  // namespace grainray::picture
