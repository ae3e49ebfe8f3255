// The visible parts of the scene's planes: convex polygons, cut to the room that the planes enclose together.
#pragma once

#include <vector>

#include "render/subject.hpp"

namespace grainray::picture {

/// Everything relative to the subject's origin.
struct Panel {
    Vec3d point, normal;          ///< the normal points into the particles' room
    std::vector<Vec3d> outline;   ///< corners within the display box, for lines and framing
    std::vector<Vec3d> surface;   ///< corners of the part to fill: a floor reaches farther than its outline and fades
    bool floor = false;           ///< the ground: the only plane that faces up
    bool shows_face(const Vec3d& eye) const { return dot(normal, eye - point) > 0; }
};

struct Room {
    std::vector<Panel> panels;
    Box box;                              ///< where the planes enclose the room their extent, elsewhere a little more than the particles'
    bool open_below[3]{}, open_above[3]{};  ///< is the room open towards lower and higher x, y, z?
    double fade = 1;                      ///< distance over which floors fade beyond the box where it is open
};

Room make_room(const Scene&, const Subject&, const Vec3d& up, double time);

/// How much of a floor is left at a point beyond the box: 1 within, 0 far out.
float floor_presence(const Room&, const Vec3f& at);

}  // namespace grainray::picture
