#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "deposit/deposit.hpp"

namespace grainray::deposit {

namespace {

void check(const Frame& frame) {
    if (frame.size() == 0) throw InputError("the frame holds no grain, so there is no deposit to measure");
    if (frame.radius.size() != frame.size()) throw InputError("the frame has no radii: write the field \"radius\" to measure a deposit");
}

double weight(const Frame& frame, std::size_t i) { return std::pow(static_cast<double>(frame.radius[i]), 3); }

/// Mean place of some grains, weighted by volume.
Vec3d mean_place(const Frame& frame, const std::vector<std::uint32_t>& grains) {
    Vec3d sum;
    double whole = 0;
    for (const std::uint32_t i : grains) {
        sum += (frame.position[i] - frame.position[0]) * weight(frame, i);
        whole += weight(frame, i);
    }
    return frame.position[0] + sum * (1 / whole);
}

std::vector<std::uint32_t> all(const Frame& frame) {
    std::vector<std::uint32_t> grains(frame.size());
    std::iota(grains.begin(), grains.end(), 0u);
    return grains;
}

/// Grains by their distance along an axis, and the one up to which a share of the volume lies.
struct Sorted {
    const Frame& frame;
    const Axis& axis;
    std::vector<std::uint32_t> grains;
    double whole = 0;

    Sorted(const Frame& f, const Axis& a) : frame(f), axis(a), grains(all(f)) {
        check(f);
        std::sort(grains.begin(), grains.end(), [&](auto i, auto j) { return along(i) < along(j); });
        for (const std::uint32_t i : grains) whole += weight(frame, i);
    }
    double along(std::uint32_t i) const { return axis.along(frame.position[i].x, frame.position[i].y); }
    std::size_t behind(double share) const {
        double sum = 0;
        for (std::size_t k = 0; k < grains.size(); ++k)
            if ((sum += weight(frame, grains[k])) >= share * whole * (1 - 1e-12)) return k;
        return grains.size() - 1;
    }
    double distance(double share) const { return along(grains[behind(share)]); }
    Vec3d rear() const { return mean_place(frame, {grains.begin(), grains.begin() + static_cast<std::ptrdiff_t>(behind(0.01)) + 1}); }
    Vec3d front() const { return mean_place(frame, {grains.begin() + static_cast<std::ptrdiff_t>(behind(0.99)), grains.end()}); }
};

}  // namespace

Axis flow_axis(const Frame& start, double dx, double dy) {
    check(start);
    const double size = std::hypot(dx, dy);
    if (!(size > 0 && std::isfinite(size))) throw InputError(fmt::format("the axis {}, {} is no direction; give a vector that is not zero", dx, dy));
    Axis axis{start.position[0].x, start.position[0].y, dx / size, dy / size};
    const double rear = Sorted(start, axis).distance(0.01);
    const Vec3d centre = mean_place(start, all(start));
    const double at = rear - axis.along(centre.x, centre.y);  // the axis goes through the centre of mass
    axis.x = centre.x + at * axis.dx;
    axis.y = centre.y + at * axis.dy;
    return axis;
}

Axis flow_axis(const Frame& start, const Frame& now) {
    check(start);
    check(now);
    const Vec3d way = mean_place(now, all(now)) - mean_place(start, all(start));
    if (std::hypot(way.x, way.y) < 1e-6 * static_cast<double>(now.radius[0]))
        throw InputError("the grains have not moved on the map, so the flow has no direction; give one with --axis");
    return flow_axis(start, way.x, way.y);
}

Runout runout(const Frame& start, const Frame& now, const Axis& axis) {
    const Sorted before(start, axis), after(now, axis);
    const Vec3d front = after.front(), from = mean_place(start, all(start)), to = mean_place(now, all(now));
    Runout r{};
    r.front = after.distance(0.99);
    r.front_95 = after.distance(0.95);
    r.farthest = after.distance(1);
    r.x = front.x;
    r.y = front.y;
    r.fall = before.rear().z - front.z;
    r.reach_angle = std::atan2(r.fall, r.front) * 180 / 3.14159265358979323846;
    r.centre_travel = axis.along(to.x, to.y) - axis.along(from.x, from.y);
    r.centre_fall = from.z - to.z;
    return r;
}

std::vector<ProfileRow> profile(const Maps& maps, const ElevationGrid& cells, const Axis& axis, double bin) {
    if (!(bin > 0 && std::isfinite(bin))) throw InputError(fmt::format("bins of {} m: they must be larger than 0", bin));
    const auto bin_of = [&](std::int64_t i, std::int64_t j) {
        return static_cast<std::int64_t>(std::floor(axis.along(cells.x + static_cast<double>(i) * cells.dx, cells.y + static_cast<double>(j) * cells.dy) / bin));
    };
    const auto each_wet = [&](const auto& visit) {
        for (std::int64_t j = 0; j < cells.rows; ++j)
            for (std::int64_t i = 0; i < cells.columns; ++i)
                if (maps.depth.at(i, j) > 0) visit(i, j);
    };
    std::int64_t first = std::numeric_limits<std::int64_t>::max(), last = std::numeric_limits<std::int64_t>::min();
    each_wet([&](std::int64_t i, std::int64_t j) { first = std::min(first, bin_of(i, j)), last = std::max(last, bin_of(i, j)); });
    std::vector<ProfileRow> rows;
    for (std::int64_t k = first; k <= last && first <= last; ++k) rows.push_back({(static_cast<double>(k) + 0.5) * bin, 0, 0, 0, 0, 0});
    std::vector<double> count(rows.size(), 0);
    each_wet([&](std::int64_t i, std::int64_t j) {
        const auto k = static_cast<std::size_t>(bin_of(i, j) - first);
        const double depth = maps.depth.at(i, j);
        ++count[k];
        rows[k].ground += cells.at(i, j);
        rows[k].depth += depth;
        rows[k].deepest = std::max(rows[k].deepest, depth);
        rows[k].speed += depth * maps.speed.at(i, j);
    });
    for (std::size_t k = 0; k < rows.size(); ++k) {
        if (count[k] == 0) continue;
        rows[k].speed /= rows[k].depth;
        rows[k].depth /= count[k];
        rows[k].ground /= count[k];
        rows[k].width = count[k] * cells.dx * cells.dy / bin;
    }
    return rows;
}

}  // namespace grainray::deposit
