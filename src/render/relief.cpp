#include "render/relief.hpp"

#include <cmath>
#include <limits>

#include "render/paint.hpp"

namespace grainray::picture {

namespace {

constexpr std::int64_t finest = 2048;  // nodes along a side: more are finer than a picture shows
constexpr double beyond = 0.18;        // of the subject's size: how much ground is shown about it

constexpr Color low{0.66f, 0.68f, 0.58f}, middle{0.78f, 0.74f, 0.65f}, high{0.86f, 0.84f, 0.81f};  // display values, by elevation
constexpr Color rock{0.63f, 0.61f, 0.59f}, cut{0.60f, 0.55f, 0.49f};

/// Every `stride`-th node from first to last, the last included.
std::vector<std::int64_t> nodes(double lower, double upper, double start, double step, std::int64_t count) {
    const auto node = [&](double at) { return std::clamp(static_cast<std::int64_t>(at), std::int64_t{0}, count - 1); };
    std::int64_t first = node(std::floor((lower - start) / step)), last = node(std::ceil((upper - start) / step));
    if (first == last) first = std::max<std::int64_t>(0, last - 1), last = first + 1;
    const std::int64_t stride = (last - first) / finest + 1;
    std::vector<std::int64_t> result;
    for (std::int64_t k = first; k < last; k += stride) result.push_back(k);
    result.push_back(last);
    return result;
}

class Cutter {
public:
    Cutter(const ElevationGrid& grid, const Subject& subject) : grid_(grid), origin_(subject.origin) {
        const Vec3d size = subject.bounds.extent();
        const double margin = std::max(beyond * std::max(size.x, size.y), 4 * std::max(grid.dx, grid.dy));
        const Vec3d lower = subject.bounds.lower + origin_, upper = subject.bounds.upper + origin_;
        columns_ = nodes(lower.x - margin, upper.x + margin, grid.x, grid.dx, grid.columns);
        rows_ = nodes(lower.y - margin, upper.y + margin, grid.y, grid.dy, grid.rows);
    }

    void surface(Relief& relief) const {
        Skin& skin = relief.surface;
        skin.vertices.reserve(columns_.size() * rows_.size() + 1);
        const double infinity = std::numeric_limits<double>::infinity();
        relief.box = {place(0, 0), place(columns_.size() - 1, rows_.size() - 1)};
        relief.box.lower.z = infinity, relief.box.upper.z = -infinity;
        for (std::size_t j = 0; j < rows_.size(); ++j)
            for (std::size_t i = 0; i < columns_.size(); ++i) {
                const Vec3d p = place(i, j);
                skin.vertices.push_back(convert<float>(p));
                skin.normals.push_back(normal(columns_[i], rows_[j]));
                relief.box.lower.z = std::fmin(relief.box.lower.z, p.z);
                relief.box.upper.z = std::fmax(relief.box.upper.z, p.z);
            }
        if (relief.box.upper.z < relief.box.lower.z) relief.box.lower.z = relief.box.upper.z = 0;  // holes only
        for (std::size_t j = 0; j + 1 < rows_.size(); ++j)
            for (std::size_t i = 0; i + 1 < columns_.size(); ++i) {
                add(skin, {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
                add(skin, {vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
            }
    }

    /// Upright sides from the surface down to the base of the block.
    void sides(Relief& relief) const {
        const std::size_t last_i = columns_.size() - 1, last_j = rows_.size() - 1;
        for (std::size_t i = 0; i < last_i; ++i) {
            side(relief, vertex(i, 0), vertex(i + 1, 0), {0, -1, 0});
            side(relief, vertex(i, last_j), vertex(i + 1, last_j), {0, 1, 0});
        }
        for (std::size_t j = 0; j < last_j; ++j) {
            side(relief, vertex(0, j), vertex(0, j + 1), {-1, 0, 0});
            side(relief, vertex(last_i, j), vertex(last_i, j + 1), {1, 0, 0});
        }
        relief.sides.vertices.reserve(relief.sides.vertices.size() + 1);
    }

private:
    std::uint32_t vertex(std::size_t i, std::size_t j) const { return static_cast<std::uint32_t>(j * columns_.size() + i); }

    Vec3d place(std::size_t i, std::size_t j) const {
        const std::int64_t column = columns_[i], row = rows_[j];
        return Vec3d{grid_.x + static_cast<double>(column) * grid_.dx, grid_.y + static_cast<double>(row) * grid_.dy, grid_.at(column, row)} - origin_;
    }

    /// Slope along an axis between the neighbours, where they are there.
    double slope(std::int64_t i, std::int64_t j, std::int64_t di, std::int64_t dj, double step) const {
        const auto at = [&](std::int64_t k) {
            const std::int64_t u = i + k * di, v = j + k * dj;
            return u < 0 || v < 0 || u >= grid_.columns || v >= grid_.rows ? std::numeric_limits<double>::quiet_NaN() : grid_.at(u, v);
        };
        const double before = at(-1), here = at(0), after = at(1);
        if (!std::isnan(before) && !std::isnan(after)) return (after - before) / (2 * step);
        if (!std::isnan(after)) return (after - here) / step;
        return std::isnan(before) ? 0 : (here - before) / step;
    }
    Vec3f normal(std::int64_t i, std::int64_t j) const {
        const double gx = slope(i, j, 1, 0, grid_.dx), gy = slope(i, j, 0, 1, grid_.dy);
        return std::isnan(gx + gy) ? Vec3f{0, 0, 1} : convert<float>(normalized(Vec3d{-gx, -gy, 1}));
    }

    static void add(Skin& skin, const std::array<std::uint32_t, 3>& t) {
        for (const std::uint32_t v : t)
            if (std::isnan(skin.vertices[v].z)) return;
        skin.triangles.push_back(t);
    }

    static void side(Relief& relief, std::uint32_t a, std::uint32_t b, const Vec3f& outwards) {
        const Vec3f &p = relief.surface.vertices[a], &q = relief.surface.vertices[b];
        if (std::isnan(p.z) || std::isnan(q.z)) return;
        Skin& skin = relief.sides;
        const float base = static_cast<float>(relief.box.lower.z);
        const auto first = static_cast<std::uint32_t>(skin.vertices.size());
        for (const Vec3f& v : {p, q, Vec3f{q.x, q.y, base}, Vec3f{p.x, p.y, base}}) {
            skin.vertices.push_back(v);
            skin.normals.push_back(outwards);
        }
        skin.triangles.push_back({first, first + 1, first + 2});
        skin.triangles.push_back({first, first + 2, first + 3});
    }

    const ElevationGrid& grid_;
    Vec3d origin_;
    std::vector<std::int64_t> columns_, rows_;
};

}  // namespace

Relief make_relief(const ElevationGrid& grid, const Subject& subject) {
    Relief relief{&grid, subject.origin, {}, {}, {}, 0, 0};
    const Cutter cutter(grid, subject);
    cutter.surface(relief);
    const double rise = relief.box.upper.z - relief.box.lower.z, wide = std::max(relief.box.extent().x, relief.box.extent().y);
    relief.box.lower.z -= 0.04 * wide;
    cutter.sides(relief);
    relief.interval = rise > 0 ? tick_step(0, rise / 3) : 0;  // 7 to 18 lines
    relief.line = static_cast<float>(7e-4 * wide);
    return relief;
}

Color Relief::color(const Vec3f& at, const Vec3f& normal) const {
    const float rise = static_cast<float>((at.z - box.lower.z) / (box.upper.z - box.lower.z + 1e-30));
    Color c = rise < 0.5f ? mix(low, middle, smooth_step(2 * rise)) : mix(middle, high, smooth_step(2 * rise - 1));
    const float flat = std::hypot(normal.x, normal.y), steep = flat / std::max(std::abs(normal.z), 1e-6f);
    c = mix(c, rock, 0.8f * smooth_step((steep - 0.6f) / 0.9f));
    if (interval > 0) {  // a line where the nearest contour is close on the map
        const double lines = (at.z + origin.z) / interval, off = std::abs(lines - std::round(lines)) * interval;
        const float away = static_cast<float>(off) / std::max(steep, 1e-3f);
        const bool index = std::fmod(std::abs(std::round(lines)), 5) == 0;
        if (away < line * (index ? 1.6f : 1.f)) c = c * (index ? 0.78f : 0.87f);
    }
    return linear_from_display(c);
}

/// A little darker towards the base.
Color Relief::side_color(const Vec3f& at) const {
    const float rise = static_cast<float>((at.z - box.lower.z) / (box.upper.z - box.lower.z + 1e-30));
    return linear_from_display(cut * (0.88f + 0.12f * smooth_step(2 * rise)));
}

bool Relief::sees(const Vec3d& from, const Vec3d& to) const {
    constexpr int steps = 300;
    for (int k = 1; k <= steps; ++k) {
        const Vec3d p = from + (to - from) * (static_cast<double>(k) / steps);
        if (p.x < box.lower.x || p.y < box.lower.y || p.x > box.upper.x || p.y > box.upper.y || p.z > box.upper.z) return true;
        if (p.z + origin.z < ground->height(p.x + origin.x, p.y + origin.y)) return false;
    }
    return true;
}

Vec3d Relief::downhill(const Subject& subject) const {
    Vec3d sum;
    const std::size_t stride = subject.spheres.size() / 2000 + 1;
    for (std::size_t k = 0; k < subject.spheres.size(); k += stride) {
        const Vec3d p = convert<double>(subject.spheres[k].centre) + origin;
        const double gx = (ground->height(p.x + ground->dx, p.y) - ground->height(p.x - ground->dx, p.y)) / (2 * ground->dx);
        const double gy = (ground->height(p.x, p.y + ground->dy) - ground->height(p.x, p.y - ground->dy)) / (2 * ground->dy);
        if (!std::isnan(gx + gy)) sum -= Vec3d{gx, gy, 0};
    }
    return length(sum) > 0 ? normalized(sum) : sum;
}

}  // namespace grainray::picture
