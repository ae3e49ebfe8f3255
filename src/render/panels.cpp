#include "render/panels.hpp"

#include <algorithm>

#include "render/math.hpp"

namespace grainray::picture {

namespace {

using Polygon = std::vector<Vec3d>;

struct HalfSpace {
    Vec3d point, normal;
    double height(const Vec3d& p) const { return dot(normal, p - point); }
};

/// A square in the plane, centred below the local zero.
Polygon square(const HalfSpace& plane, double half) {
    const Vec3d n = plane.normal, centre = n * dot(n, plane.point);
    const Vec3d a = normalized(cross(n, std::abs(n.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0})) * half, b = cross(n, a);
    return {centre + a + b, centre - a + b, centre - a - b, centre + a - b};
}

/// The part of a convex polygon inside the half-space.
Polygon clip(const Polygon& polygon, const HalfSpace& side, double tolerance) {
    Polygon inside;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3d &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const double hp = side.height(p), hq = side.height(q);
        if (hp >= -tolerance) inside.push_back(p);
        if ((hp < -tolerance && hq > tolerance) || (hp > tolerance && hq < -tolerance)) inside.push_back(p + (q - p) * (hp / (hp - hq)));
    }
    return inside.size() < 3 ? Polygon{} : inside;
}

Vec3d axis_vector(int axis, double sign) {
    Vec3d v;
    v[axis] = sign;
    return v;
}

/// The six faces, normals inwards: lower and upper x, lower and upper y, ...
std::vector<HalfSpace> box_faces(const Box& box) {
    std::vector<HalfSpace> faces;
    for (int axis = 0; axis < 3; ++axis) {
        faces.push_back({box.lower, axis_vector(axis, 1)});
        faces.push_back({box.upper, axis_vector(axis, -1)});
    }
    return faces;
}

Box padded(const Box& box, double by) { return {box.lower - Vec3d{by, by, by}, box.upper + Vec3d{by, by, by}}; }

/// The face of `plane` on the solid that all the half-spaces enclose.
Polygon face(const HalfSpace& plane, const std::vector<HalfSpace>& all, double size) {
    Polygon polygon = square(plane, 4 * size);
    for (const HalfSpace& other : all)
        if (&other != &plane) polygon = clip(polygon, other, 1e-9 * size);
    return polygon;
}

std::vector<HalfSpace> local_planes(const Scene& scene, const Subject& subject, double time) {
    std::vector<HalfSpace> planes;
    for (const Plane& plane : scene.planes) {
        const PlaneState state = plane_at(plane, time);
        planes.push_back({state.point - subject.origin, normalized(state.normal)});
    }
    return planes;
}

double mean_radius(const Subject& subject) {
    double sum = 0;
    for (const Sphere& s : subject.spheres) sum += s.radius;
    return subject.spheres.empty() ? 0 : sum / static_cast<double>(subject.spheres.size());
}

/// Looks as far as `reach`: where the room still goes on there it is open and gets the particles' bounds instead.
void measure(Room& room, std::vector<HalfSpace> sides, const Box& bounds, double pad, double reach) {
    const std::size_t planes = sides.size();
    const Box far = padded(bounds, reach);
    for (const HalfSpace& f : box_faces(far)) sides.push_back(f);
    Box extent{far.upper, far.lower};
    for (std::size_t k = 0; k < sides.size(); ++k) {
        const Polygon polygon = face(sides[k], sides, length(far.extent()));
        for (const Vec3d& corner : polygon)
            for (int axis = 0; axis < 3; ++axis) {
                extent.lower[axis] = std::min(extent.lower[axis], corner[axis]);
                extent.upper[axis] = std::max(extent.upper[axis], corner[axis]);
            }
        if (k < planes || polygon.empty()) continue;
        const std::size_t open = k - planes;
        (open % 2 ? room.open_above : room.open_below)[open / 2] = true;
    }
    room.box = padded(bounds, pad);
    for (int axis = 0; axis < 3; ++axis) {
        if (!room.open_below[axis]) room.box.lower[axis] = extent.lower[axis];
        if (!room.open_above[axis]) room.box.upper[axis] = extent.upper[axis];
    }
}

/// The box grown by `fade` where the room is open.
Box fade_box(const Room& room) {
    Box box = room.box;
    for (int axis = 0; axis < 3; ++axis) {
        if (room.open_below[axis]) box.lower[axis] -= room.fade;
        if (room.open_above[axis]) box.upper[axis] += room.fade;
    }
    return box;
}

}  // namespace

Room make_room(const Scene& scene, const Subject& subject, const Vec3d& up, double time) {
    Room room;
    const double diagonal = subject.diagonal(), pad = std::max(0.02 * diagonal, mean_radius(subject));
    room.fade = 0.35 * diagonal;
    const std::vector<HalfSpace> planes = local_planes(scene, subject, time);
    measure(room, planes, subject.bounds, pad, 1.5 * diagonal);

    const auto within = [&](const Box& box, std::size_t k) {
        std::vector<HalfSpace> sides = planes;
        // A hair wider: a face of the box may be the very plane that is being cut.
        for (const HalfSpace& f : box_faces(padded(box, 1e-6 * diagonal))) sides.push_back(f);
        return face(sides[k], sides, 2 * diagonal + length(box.extent()));
    };
    const auto faces_up = [&](const HalfSpace& plane, double least) { return dot(plane.normal, normalized(up)) > least; };
    const bool one_ground = std::count_if(planes.begin(), planes.end(), [&](const HalfSpace& p) { return faces_up(p, 0.7); }) == 1;
    for (std::size_t k = 0; k < planes.size(); ++k) {
        Panel panel{planes[k].point, planes[k].normal, within(room.box, k), {}, one_ground && faces_up(planes[k], 0.9)};
        panel.surface = panel.floor ? within(fade_box(room), k) : panel.outline;
        if (panel.surface.size() > 2) room.panels.push_back(std::move(panel));
    }
    return room;
}

float floor_presence(const Room& room, const Vec3f& at) {
    double beyond = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double below = room.open_below[axis] ? room.box.lower[axis] - at[axis] : 0;
        const double above = room.open_above[axis] ? at[axis] - room.box.upper[axis] : 0;
        const double d = std::max({below, above, 0.0});
        beyond += d * d;
    }
    return 1 - smooth_step(static_cast<float>(std::sqrt(beyond) / room.fade));
}

}  // namespace grainray::picture
