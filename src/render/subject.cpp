#include "render/subject.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "render/math.hpp"

namespace grainray::picture {

double percentile(std::vector<double>& values, double q) {
    const double last = static_cast<double>(values.size() - 1);
    const auto nth = values.begin() + static_cast<std::ptrdiff_t>(q < 0.5 ? std::floor(q * last) : std::ceil(q * last));
    std::nth_element(values.begin(), nth, values.end());
    return *nth;
}

void grow(Box& box, const Box& by) {
    for (int axis = 0; axis < 3; ++axis) {
        box.lower[axis] = std::min(box.lower[axis], by.lower[axis]);
        box.upper[axis] = std::max(box.upper[axis], by.upper[axis]);
    }
}

namespace {

bool drawable(const Vec3d& p, float radius) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && std::isfinite(radius) && radius > 0;
}

/// The range of the values without the few far away: what lies a tenth beyond the percentiles still counts.
struct Range { double low, high; };
Range robust_range(std::vector<double>& lower, std::vector<double>& upper) {
    const double low = percentile(lower, 0.005), high = percentile(upper, 0.995);
    const double allowance = 0.1 * (high - low);
    return {std::max(low - allowance, *std::min_element(lower.begin(), lower.end())),
            std::min(high + allowance, *std::max_element(upper.begin(), upper.end()))};
}

Box world_bounds(const Frame& frame, const std::vector<std::uint32_t>& index) {
    Box box;
    std::vector<double> lower(index.size()), upper(index.size());
    for (int axis = 0; axis < 3; ++axis) {
        for (std::size_t k = 0; k < index.size(); ++k) {
            const double at = frame.position[index[k]][axis], radius = frame.radius[index[k]];
            lower[k] = at - radius;
            upper[k] = at + radius;
        }
        const Range range = robust_range(lower, upper);
        box.lower[axis] = range.low;
        box.upper[axis] = range.high;
    }
    return box;
}

constexpr double much_larger = 20;  // times the particles' extent: such a mesh is ground, not a vessel

void find_drawable(Subject& subject, const Frame& frame) {
    if (frame.radius.size() != frame.size())
        throw InputError(fmt::format("the frame has {} positions but {} radii: write the field \"radius\" to draw it",
                                     frame.size(), frame.radius.size()));
    for (std::size_t i = 0; i < frame.size(); ++i)
        if (drawable(frame.position[i], frame.radius[i])) subject.index.push_back(static_cast<std::uint32_t>(i));
}

void add_spheres(Subject& subject, const Frame& frame) {
    subject.spheres.reserve(subject.index.size());
    for (const std::uint32_t i : subject.index)
        subject.spheres.push_back({convert<float>(frame.position[i] - subject.origin), frame.radius[i]});
}

/// Where to look when there is no particle: the domain, else a little room about the planes.
Box bounds_without_particles(const Scene& scene, double time) {
    if (scene.domain.box) return *scene.domain.box;
    Vec3d middle;
    for (const Plane& plane : scene.planes) middle += plane_at(plane, time).point * (1.0 / static_cast<double>(scene.planes.size()));
    return {middle - Vec3d{1, 1, 1}, middle + Vec3d{1, 1, 1}};
}

}  // namespace

Subject make_subject(const Frame& frame, const Scene& scene, const std::optional<Box>& meshes) {
    Subject subject;
    find_drawable(subject, frame);
    Box world = subject.index.empty() ? meshes ? *meshes : bounds_without_particles(scene, frame.time) : world_bounds(frame, subject.index);
    if (meshes && length(meshes->extent()) < much_larger * length(world.extent())) grow(world, *meshes);
    subject.origin = (world.lower + world.upper) * 0.5;
    subject.bounds = {world.lower - subject.origin, world.upper - subject.origin};
    add_spheres(subject, frame);
    return subject;
}

Subject make_subject_like(const Subject& other, const Frame& frame) {
    Subject subject;
    subject.origin = other.origin;
    subject.bounds = other.bounds;
    find_drawable(subject, frame);
    add_spheres(subject, frame);
    return subject;
}

}  // namespace grainray::picture
