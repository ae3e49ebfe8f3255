#include "scene/sphere_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace grainray::scene {
namespace {

/// x wrapped into 0 <= x < n, for x at most one period outside or so.
std::int64_t wrapped(std::int64_t x, std::int64_t n) {
    const std::int64_t r = x % n;
    return r < 0 ? r + n : r;
}

}  // namespace

SphereGrid::SphereGrid(const Box& box, std::array<bool, 3> wraps, double largest, std::size_t capacity)
    : box_(box), extent_(box.extent()), wraps_(wraps), largest_(largest), first_(std::bit_ceil(2 * capacity + 1), -1) {
    spheres_.reserve(capacity);
}

SphereGrid::Level SphereGrid::make_level(std::size_t index) const {
    Level level{std::ldexp(largest_, -static_cast<int>(index)), {}, {}};
    for (int axis = 0; axis < 3; ++axis) {
        const double cells = std::clamp(std::floor(extent_[axis] / (2 * level.reach)), 1.0, 0x1p40);
        level.cells[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(cells);
        level.cell[axis] = extent_[axis] / cells;
    }
    return level;
}

std::size_t SphereGrid::level_of(double radius) const {
    std::size_t level = 0;
    while (std::ldexp(largest_, -static_cast<int>(level) - 1) >= radius) ++level;
    return level;
}

std::size_t SphereGrid::bucket(std::size_t level, std::int64_t x, std::int64_t y, std::int64_t z) const {
    std::uint64_t h = level * 0x9e3779b97f4a7c15;
    for (const std::int64_t c : {x, y, z}) h = (h ^ static_cast<std::uint64_t>(c)) * 0xbf58476d1ce4e5b9, h ^= h >> 29;
    return static_cast<std::size_t>(h) & (first_.size() - 1);
}

void SphereGrid::insert(const Vec3d& centre, double radius) {
    const std::size_t index = level_of(radius);
    while (levels_.size() <= index) levels_.push_back(make_level(levels_.size()));
    const Level& level = levels_[index];
    std::array<std::int64_t, 3> c;
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        c[a] = std::clamp<std::int64_t>(
            static_cast<std::int64_t>(std::floor((centre[axis] - box_.lower[axis]) / level.cell[axis])), 0,
            level.cells[a] - 1);
    }
    std::int64_t& head = first_[bucket(index, c[0], c[1], c[2])];
    spheres_.push_back({centre, radius, head});
    head = static_cast<std::int64_t>(spheres_.size()) - 1;
}

bool SphereGrid::bucket_overlaps(std::size_t index, const Vec3d& centre, double radius) const {
    for (std::int64_t i = first_[index]; i >= 0; i = spheres_[static_cast<std::size_t>(i)].next) {
        const Sphere& other = spheres_[static_cast<std::size_t>(i)];
        Vec3d d = centre - other.centre;
        for (int axis = 0; axis < 3; ++axis)
            if (wraps_[static_cast<std::size_t>(axis)]) d[axis] -= extent_[axis] * std::round(d[axis] / extent_[axis]);
        const double reach = radius + other.radius;
        if (dot(d, d) < reach * reach) return true;
    }
    return false;
}

bool SphereGrid::level_overlaps(std::size_t index, const Vec3d& centre, double radius) const {
    const Level& level = levels_[index];
    std::array<std::int64_t, 3> lower, upper;
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const double x = centre[axis] - box_.lower[axis], reach = radius + level.reach;
        lower[a] = static_cast<std::int64_t>(std::floor((x - reach) / level.cell[axis]));
        upper[a] = static_cast<std::int64_t>(std::floor((x + reach) / level.cell[axis]));
        if (wraps_[a]) upper[a] = std::min(upper[a], lower[a] + level.cells[a] - 1);  // no cell twice
        else lower[a] = std::max<std::int64_t>(lower[a], 0), upper[a] = std::min(upper[a], level.cells[a] - 1);
    }
    for (std::int64_t z = lower[2]; z <= upper[2]; ++z)
        for (std::int64_t y = lower[1]; y <= upper[1]; ++y)
            for (std::int64_t x = lower[0]; x <= upper[0]; ++x)
                if (bucket_overlaps(bucket(index, wrapped(x, level.cells[0]), wrapped(y, level.cells[1]),
                                           wrapped(z, level.cells[2])),
                                    centre, radius))
                    return true;
    return false;
}

bool SphereGrid::overlaps(const Vec3d& centre, double radius) const {
    for (std::size_t level = 0; level < levels_.size(); ++level)
        if (level_overlaps(level, centre, radius)) return true;
    return false;
}

}  // namespace grainray::scene
