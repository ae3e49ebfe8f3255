#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "deposit/deposit.hpp"
#include "deposit/share.hpp"

namespace grainray::deposit {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double volume_of(double radius) { return 4.0 / 3.0 * 3.14159265358979323846 * radius * radius * radius; }

void check(const Frame& frame, double solid_fraction) {
    if (frame.radius.size() != frame.size() || frame.velocity.size() != frame.size())
        throw InputError("the frame has no radii or no velocities: write the fields \"radius\" and \"velocity\" to measure a deposit");
    if (!(solid_fraction > 0 && solid_fraction <= 1))
        throw InputError(fmt::format("the solid fraction {} must be above 0 and at most 1: it is the volume of the grains over that of the deposit", solid_fraction));
}

class Mapper {
public:
    Mapper(const ElevationGrid& ground, const ElevationGrid& cells) : ground_(ground), cells_(cells), across_{cells.x, cells.dx}, along_{cells.y, cells.dy} {
        maps.depth = maps.top = maps.speed = cells;
        for (ElevationGrid* map : {&maps.depth, &maps.top, &maps.speed}) std::fill(map->heights.begin(), map->heights.end(), 0.0);
    }

    /// Until finish(), depth holds volume and speed holds volume times speed.
    void add(const Vec3d& p, double r, double speed) {
        const double whole = volume_of(r);
        share_sphere(across_, along_, p.x, p.y, r, [&](std::int64_t i, std::int64_t j, double share) {
            if (!has_ground(i, j)) {
                maps.beyond += share * whole;
                return;
            }
            maps.volume += share * whole;
            at(maps.depth, i, j) += share * whole;
            at(maps.speed, i, j) += share * whole * speed;
        });
        raise(across_.cell(p.x), along_.cell(p.y), p.z + r - ground_.height(p.x, p.y));
        for (std::int64_t j = along_.cell(p.y - r); j <= along_.cell(p.y + r); ++j)
            for (std::int64_t i = across_.cell(p.x - r); i <= across_.cell(p.x + r); ++i) {
                const double dx = cells_.x + static_cast<double>(i) * cells_.dx - p.x, dy = cells_.y + static_cast<double>(j) * cells_.dy - p.y, left = r * r - dx * dx - dy * dy;
                if (left >= 0) raise(i, j, p.z + std::sqrt(left) - ground_.height(p.x + dx, p.y + dy));
            }
    }

    Maps finish(double solid_fraction) {
        for (std::size_t k = 0; k < cells_.heights.size(); ++k) {
            double &depth = maps.depth.heights[k], &speed = maps.speed.heights[k];
            speed = depth > 0 ? speed / depth : nan;
            depth /= cells_.dx * cells_.dy * solid_fraction;
            if (std::isnan(cells_.heights[k])) depth = maps.top.heights[k] = nan;
        }
        return std::move(maps);
    }

private:
    bool inside(std::int64_t i, std::int64_t j) const { return i >= 0 && j >= 0 && i < cells_.columns && j < cells_.rows; }
    bool has_ground(std::int64_t i, std::int64_t j) const { return inside(i, j) && !std::isnan(cells_.at(i, j)); }
    double& at(ElevationGrid& map, std::int64_t i, std::int64_t j) const { return map.heights[static_cast<std::size_t>(j * cells_.columns + i)]; }
    void raise(std::int64_t i, std::int64_t j, double height) {
        if (has_ground(i, j)) at(maps.top, i, j) = std::fmax(at(maps.top, i, j), height);
    }

    const ElevationGrid &ground_, &cells_;
    CellLine across_, along_;
    Maps maps;
};

}  // namespace

ElevationGrid cells_of_size(const ElevationGrid& ground, double size) {
    const double wide = static_cast<double>(ground.columns - 1) * ground.dx, high = static_cast<double>(ground.rows - 1) * ground.dy;
    if (!(size > 0 && size <= std::min(wide, high) && wide / size * (high / size) <= 1e9))
        throw InputError(fmt::format("cells of {} m: on ground of {} x {} m they must be larger than 0, at most as large as the ground and not more than 1e9", size, wide, high));
    ElevationGrid cells{static_cast<std::int64_t>(wide / size + 1e-9) + 1, static_cast<std::int64_t>(high / size + 1e-9) + 1, ground.x, ground.y, size, size, {}};
    for (std::int64_t j = 0; j < cells.rows; ++j)
        for (std::int64_t i = 0; i < cells.columns; ++i) {
            const double x = std::min(static_cast<double>(i) * size, wide), y = std::min(static_cast<double>(j) * size, high);
            cells.heights.push_back(ground.height(ground.x + x, ground.y + y));
        }
    return cells;
}

Maps map(const Frame& frame, const ElevationGrid& ground, const ElevationGrid& cells, double solid_fraction) {
    check(frame, solid_fraction);
    Mapper mapper(ground, cells);
    for (std::size_t i = 0; i < frame.size(); ++i)
        mapper.add(frame.position[i], static_cast<double>(frame.radius[i]), length(convert<double>(frame.velocity[i])));
    return mapper.finish(solid_fraction);
}

}  // namespace grainray::deposit
