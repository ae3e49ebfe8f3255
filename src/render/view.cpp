#include "render/view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "render/math.hpp"

namespace grainray::picture {

namespace {

constexpr double degree = std::numbers::pi / 180;

/// x, or where that is the axis itself y, made perpendicular to `up`.
Vec3d sideways(const Vec3d& up) {
    const Vec3d start = std::abs(up.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    return normalized(start - up * dot(start, up));
}

/// From the front (-y), a little from the right (+x) and from above: a column that collapses to +x runs to the right.
/// The longer it is, the squarer the view, or its far end would be small.
Vec3d three_quarter(const Vec3d& up, const Vec3d& extent) {
    const Vec3d x = sideways(up), y = cross(up, x);
    const auto size = [&](const Vec3d& a) { return std::abs(a.x) * extent.x + std::abs(a.y) * extent.y + std::abs(a.z) * extent.z; };
    const double slender = size(x) / (size(x) + size(y) + size(up));
    const double azimuth = (slender < 0.5 ? 28 : 28 - 40 * (slender - 0.5)) * degree, elevation = 24 * degree;
    const Vec3d from = (x * std::sin(azimuth) - y * std::cos(azimuth)) * std::cos(elevation) + up * std::sin(elevation);
    return -from;
}

void aim(View& view, const Vec3d& forward, const Vec3d& up) {
    view.forward = normalized(forward);
    Vec3d right = cross(view.forward, up);
    if (length(right) < 1e-6) right = sideways(view.forward);
    view.right = normalized(right);
    view.up = cross(view.right, view.forward);
}

/// How far a thing sticks out through the four sides of a frustum that stands at the local zero; the eye must stand back by as much.
struct Fit {
    const View& view;
    double right_slope, left_slope, top_slope, bottom_slope;
    double right = lowest, left = lowest, top = lowest, bottom = lowest;
    static constexpr double lowest = -std::numeric_limits<double>::infinity();

    Fit(const View& v, const Margins& m)
        : view(v), right_slope(v.tan_x * (1 - 2 * m.right)), left_slope(v.tan_x * (1 - 2 * m.left)),
          top_slope(v.tan_y * (1 - 2 * m.top)), bottom_slope(v.tan_y * (1 - 2 * m.bottom)) {}

    void include(const Vec3d& p, double radius) {
        const double x = dot(p, view.right), y = dot(p, view.up), z = dot(p, view.forward);
        right = std::max(right, x - right_slope * z + radius * std::hypot(1, right_slope));
        left = std::max(left, -x - left_slope * z + radius * std::hypot(1, left_slope));
        top = std::max(top, y - top_slope * z + radius * std::hypot(1, top_slope));
        bottom = std::max(bottom, -y - bottom_slope * z + radius * std::hypot(1, bottom_slope));
    }

    /// The nearest eye from which everything is inside, in the middle of the room that is left over.
    Vec3d eye() const {
        const double z = std::min(-(right + left) / (right_slope + left_slope), -(top + bottom) / (top_slope + bottom_slope));
        const double x = 0.5 * (right + right_slope * z - left - left_slope * z);
        const double y = 0.5 * (top + top_slope * z - bottom - bottom_slope * z);
        return view.right * x + view.up * y + view.forward * z;
    }

    /// How far an eye must stand back from `target` to have everything inside.
    double distance(const Vec3d& target) const {
        const double x = dot(target, view.right), y = dot(target, view.up), z = dot(target, view.forward);
        return z + std::max({(right - x) / right_slope, (left + x) / left_slope, (top - y) / top_slope, (bottom + y) / bottom_slope});
    }
};

bool inside(const Box& box, const Vec3f& p) {
    const double tolerance = 1e-6 * length(box.extent());  // corners of meshes lie on the box, but for rounding
    for (int axis = 0; axis < 3; ++axis)
        if (p[axis] < box.lower[axis] - tolerance || p[axis] > box.upper[axis] + tolerance) return false;
    return true;
}

void include_block(Fit& fit, const Relief& relief) {
    for (const Skin* skin : {&relief.surface, &relief.sides})
        for (std::size_t v = 0; v < skin->vertices.size(); v += skin->vertices.size() / 10000 + 1)
            if (!std::isnan(skin->vertices[v].z)) fit.include(convert<double>(skin->vertices[v]), 0);
}

Fit fit(const View& view, const Sights& sights, const Margins& margins) {
    const Subject& subject = sights.subject;
    Fit result(view, margins);
    const std::size_t stride = sights.relief ? subject.spheres.size() / 10000 + 1 : 1;  // the block holds them all
    for (std::size_t k = 0; k < subject.spheres.size(); k += stride)
        if (const Sphere& s = subject.spheres[k]; inside(subject.bounds, s.centre)) result.include(convert<double>(s.centre), s.radius);
    for (const Panel& panel : sights.room.panels)
        for (const Vec3d& corner : panel.outline) result.include(corner, 0);
    for (const Vec3f& corner : sights.corners)
        if (inside(subject.bounds, corner)) result.include(convert<double>(corner), 0);
    if (sights.relief) include_block(result, *sights.relief);
    if (result.right == Fit::lowest) result.include({}, 0.5 * subject.diagonal());
    return result;
}

/// From the lower side, a little from aside and from above: of such directions the one from which most of the particles
/// are seen over the ground, the first of equally good ones.
Vec3d over_terrain(View view, const Sights& sights, const Margins& margins, const Vec3d& up) {
    const Vec3d slope = sights.relief->downhill(sights.subject), down = length(slope) > 0 ? slope : -sideways(up), across = cross(up, down);
    const std::size_t stride = sights.subject.spheres.size() / 300 + 1;
    Vec3d best = -down - up;
    double most = -1;
    for (const double elevation : {32.0, 42.0, 55.0})
        for (const double azimuth : {35.0, -35.0, 10.0, -10.0, 60.0, -60.0}) {
            const double a = azimuth * degree, e = elevation * degree;
            const Vec3d from = (down * std::cos(a) + across * std::sin(a)) * std::cos(e) + up * std::sin(e);
            aim(view, -from, up);
            const Vec3d eye = fit(view, sights, margins).eye();
            double seen = 0;
            for (std::size_t k = 0; k < sights.subject.spheres.size(); k += stride) {
                const Sphere& s = sights.subject.spheres[k];
                seen += sights.relief->sees(convert<double>(s.centre) + up * (2.0 * static_cast<double>(s.radius)), eye);
            }
            const double share = seen * static_cast<double>(stride) / static_cast<double>(std::max<std::size_t>(1, sights.subject.spheres.size()));
            if (share > most + 0.02) most = share, best = -from;
        }
    return best;
}

void check(const Camera& camera) {
    if (!(camera.field_of_view >= 1 && camera.field_of_view <= 170))
        throw InputError(fmt::format("render.camera.field_of_view = {} must be 1 to 170 degrees", camera.field_of_view));
    if (!(length(camera.up) > 0 && std::isfinite(length(camera.up)))) throw InputError("render.camera.up is no direction: give a vector that is not zero");
    if (camera.eye && camera.target && *camera.eye == *camera.target)
        throw InputError("render.camera.eye and render.camera.target are the same point: move one of them");
}

/// Rays are in single precision: from farther away nothing can be told apart.
void check_distance(const char* option, const std::optional<Vec3d>& world, const Vec3d& origin, double size) {
    constexpr double farthest = 1e6;  // times the size of the picture's subject
    if (!world || length(*world - origin) <= farthest * size) return;
    throw InputError(fmt::format("render.camera.{0} (--{0}) = {1}, {2}, {3} is too far away: give a point within {4:.3g} m of {5:.3g}, {6:.3g}, {7:.3g}",
                                 option, world->x, world->y, world->z, farthest * size, origin.x, origin.y, origin.z));
}

}  // namespace

Ray View::ray(double x, double y) const {
    const double a = (2 * x / width - 1) * tan_x, b = (1 - 2 * y / height) * tan_y;
    return {convert<float>(eye), convert<float>(normalized(forward + right * a + up * b))};
}

Spot View::spot(const Vec3d& p) const {
    const Vec3d d = p - eye;
    const double depth = dot(d, forward);
    return {0.5 * width * (1 + dot(d, right) / (depth * tan_x)), 0.5 * height * (1 - dot(d, up) / (depth * tan_y)), depth};
}

View make_view(const RenderSettings& settings, const Sights& sights, const Margins& margins) {
    const Camera& camera = settings.camera;
    const Subject& subject = sights.subject;
    check(camera);
    const double size = std::max(length(sights.room.box.extent()), subject.diagonal());
    check_distance("eye", camera.eye, subject.origin, size);
    check_distance("target", camera.target, subject.origin, size);
    View view;
    view.width = static_cast<int>(settings.width);
    view.height = static_cast<int>(settings.height);
    view.tan_y = std::tan(0.5 * camera.field_of_view * degree);
    view.tan_x = view.tan_y * view.width / view.height;

    const Vec3d up = normalized(camera.up);
    const Vec3d default_direction = sights.relief ? over_terrain(view, sights, margins, up) : three_quarter(up, sights.room.box.extent());
    const Vec3d target = camera.target ? *camera.target - subject.origin : Vec3d{};
    if (camera.eye) {
        view.eye = *camera.eye - subject.origin;
        aim(view, view.eye == target ? default_direction : target - view.eye, up);
        return view;
    }
    aim(view, default_direction, up);
    const Fit framing = fit(view, sights, margins);
    view.eye = camera.target ? target - view.forward * framing.distance(target) : framing.eye();
    return view;
}

}  // namespace grainray::picture
