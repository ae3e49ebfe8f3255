// type = "release": columns of particles between the ground and a surface above it. A column of height h gets h / spacing
// particles, rounded, so that volume over spacing cubed is their number; the lowest just touches the ground.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "scene/place.hpp"
#include "scene/polygon.hpp"

namespace grainray::scene {
namespace {

class Slide {
public:
    Slide(const Scene& scene, const ParticleGroup& group, const Release& release) : ground_(load_ground(scene)), thickness_(release.thickness) {
        const auto file = release.polygon_file;
        if (!file.empty()) {
            const std::string place = fmt::format("{} = \"{}\": ", place_of(scene, group, "polygon"), file.string());
            outline_ = read_polygon(file.is_absolute() ? file : scene.file.parent_path() / file, place);
            bound_by_outline(place);
        } else {
            before_ = load_surface_before(scene);
            bound_by_difference(scene);
        }
    }

    /// Height of the layer at a point; 0 outside.
    double depth(double x, double y) const {
        const double below = ground_.height(x, y), d = outline_ ? (outline_->contains(x, y) ? thickness_ : 0) : before_->height(x, y) - below;
        return std::isnan(below) || !(d > 0) ? 0 : d;
    }

    /// visit(x, y, number) for the columns of a spacing that hold a particle.
    void each_column(double spacing, const std::function<void(double x, double y, std::int64_t number)>& visit) const {
        const auto first = [&](double low, double start) { return static_cast<std::int64_t>(std::floor((low - start) / spacing)) - 1; };
        const std::int64_t i0 = first(lower_.x, ground_.x), i1 = first(upper_.x, ground_.x) + 3, j0 = first(lower_.y, ground_.y), j1 = first(upper_.y, ground_.y) + 3;
        for (std::int64_t j = j0; j <= j1; ++j)
            for (std::int64_t i = i0; i <= i1; ++i) {
                const double x = ground_.x + (static_cast<double>(i) + 0.5) * spacing, y = ground_.y + (static_cast<double>(j) + 0.5) * spacing;
                const auto number = static_cast<std::int64_t>(std::floor(depth(x, y) / spacing + 0.5));
                if (number > 0) visit(x, y, number);
            }
    }
    std::int64_t count(double spacing) const {
        std::int64_t sum = 0;
        each_column(spacing, [&](double, double, std::int64_t number) { sum += number; });
        return sum;
    }
    /// The spacing that gives the number nearest to the one wanted: bisection, for fewer particles come of more spacing.
    double spacing_for(std::int64_t wanted) const {
        double volume = 0;
        const double step = std::min(ground_.dx, ground_.dy) / 4;
        for (double y = lower_.y; y < upper_.y; y += step)
            for (double x = lower_.x; x < upper_.x; x += step) volume += depth(x, y) * step * step;
        const double guess = std::cbrt(volume / static_cast<double>(wanted));
        double dense = 0.7 * guess, loose = 1.5 * guess, best = guess;
        for (int k = 0; k < 30; ++k) {
            const double middle = 0.5 * (dense + loose);
            const std::int64_t got = count(middle);
            if (k == 0 || std::abs(got - wanted) < std::abs(count_of_best_ - wanted)) best = middle, count_of_best_ = got;
            if (std::abs(got - wanted) <= wanted / 2000) break;
            (got > wanted ? dense : loose) = middle;
        }
        return best;
    }
    const ElevationGrid& ground() const { return ground_; }

    /// Lowest centre of a sphere above a point that does not reach into the ground: where each triangle, edge and node near
    /// by would touch it, the surface is asked for its height.
    double resting_height(double x, double y, double radius) const {
        double lowest = ground_.height(x, y);
        const auto ask = [&](double dx, double dy) {
            const double z = ground_.height(x + dx, y + dy), rest = radius * radius - dx * dx - dy * dy;
            if (!std::isnan(z) && rest > 0) lowest = std::max(lowest, z + std::sqrt(rest));
        };
        const auto ask_edge = [&](double from_x, double from_y, double ux, double uy, double rise) {
            const double along = (x - from_x) * ux + (y - from_y) * uy, beside = (x - from_x) * uy - (y - from_y) * ux;
            const double rest = radius * radius - beside * beside;
            if (!(rest > 0)) return;
            const double to = along + std::sqrt(rest) * rise / std::sqrt(1 + rise * rise);
            ask(from_x + to * ux - x, from_y + to * uy - y);
        };
        const double dx = ground_.dx, dy = ground_.dy, diagonal = std::hypot(dx, dy);
        const auto first = [&](double at, double start, double cell) { return static_cast<std::int64_t>(std::floor((at - radius - start) / cell)); };
        const auto last = [&](double at, double start, double cell) { return static_cast<std::int64_t>(std::floor((at + radius - start) / cell)) + 1; };
        for (std::int64_t j = first(y, ground_.y, dy); j <= last(y, ground_.y, dy); ++j)
            for (std::int64_t i = first(x, ground_.x, dx); i <= last(x, ground_.x, dx); ++i) {
                const double ex = ground_.x + static_cast<double>(i) * dx, ey = ground_.y + static_cast<double>(j) * dy;
                const Vec3d below = ground_.slope(ex + 2 * dx / 3, ey + dy / 3), above = ground_.slope(ex + dx / 3, ey + 2 * dy / 3);
                for (const Vec3d& slope : {below, above}) {
                    const double arm = radius / std::sqrt(1 + dot(slope, slope));
                    ask(arm * slope.x, arm * slope.y);
                }
                ask_edge(ex, ey, 1, 0, below.x);
                ask_edge(ex, ey, 0, 1, above.y);
                ask_edge(ex, ey, dx / diagonal, dy / diagonal, (below.x * dx + below.y * dy) / diagonal);
                ask(ex - x, ey - y);
            }
        return lowest + 1e-6 * radius;
    }

private:
    void bound_by_outline(const std::string& place) {
        lower_ = outline_->lower();
        upper_ = outline_->upper();
        const double east = ground_.x + ground_.dx * static_cast<double>(ground_.columns - 1), north = ground_.y + ground_.dy * static_cast<double>(ground_.rows - 1);
        if (lower_.x < ground_.x || lower_.y < ground_.y || upper_.x > east || upper_.y > north)
            throw InputError(fmt::format("{}it reaches from ({}, {}) to ({}, {}) m and the terrain from ({}, {}) to ({}, {}) m; give an outline inside the terrain, in its "
                                         "coordinates", place, lower_.x, lower_.y, upper_.x, upper_.y, ground_.x, ground_.y, east, north));
    }

    void bound_by_difference(const Scene& scene) {
        bool above = false, below = false;
        for (std::int64_t j = 0; j < ground_.rows; ++j)
            for (std::int64_t i = 0; i < ground_.columns; ++i) {
                const double d = before_->at(i, j) - ground_.at(i, j), x = ground_.x + ground_.dx * static_cast<double>(i), y = ground_.y + ground_.dy * static_cast<double>(j);
                below = below || d < 0;
                if (!(d > 0)) continue;
                lower_ = above ? Point2{std::min(lower_.x, x), std::min(lower_.y, y)} : Point2{x, y};
                upper_ = above ? Point2{std::max(upper_.x, x), std::max(upper_.y, y)} : Point2{x, y};
                above = true;
            }
        lower_ = {lower_.x - ground_.dx, lower_.y - ground_.dy};
        upper_ = {upper_.x + ground_.dx, upper_.y + ground_.dy};
        const std::string file = scene.file.empty() ? "scene" : scene.file.string();
        if (!above && below)
            throw InputError(fmt::format("{}: key 'terrain.before': it lies below terrain.after wherever they differ, so nothing could slide; exchange the two files", file));
        if (!above) throw InputError(fmt::format("{}: key 'terrain.before': it is the same surface as terrain.after, so there is no volume to fill; give the surface before the slide", file));
    }

    ElevationGrid ground_;
    std::optional<ElevationGrid> before_;
    std::optional<Polygon> outline_;
    double thickness_;
    Point2 lower_{}, upper_{};
    mutable std::int64_t count_of_best_ = 0;
};

}  // namespace

void place_release(const Scene& scene, const ParticleGroup& group, const Release& release, InitialState& state) {
    const Slide slide(scene, group, release);
    const double spacing = release.spacing > 0 ? release.spacing : slide.spacing_for(release.count);
    const double radius = release.radius > 0 ? release.radius : 0.5 * (spacing - release.jitter);
    if (!(radius > 0))
        throw InputError(fmt::format("{} = {} m: it leaves nothing of the spacing of {:.4g} m for a radius; give a smaller one", place_of(scene, group, "jitter"), release.jitter, spacing));
    const Random random(scene.seed, group.name, Stream::jitter);
    const std::size_t first = state.size();
    std::uint64_t n = 0;
    slide.each_column(spacing, [&](double column_x, double column_y, std::int64_t number) {
        const std::size_t foot = state.size();
        double lowest = slide.resting_height(column_x, column_y, radius);
        for (std::int64_t k = 0; k < number; ++k, ++n) {
            double x = column_x + release.jitter * random.uniform(2 * n), y = column_y + release.jitter * random.uniform(2 * n + 1);
            if (std::isnan(slide.ground().height(x, y))) x = column_x, y = column_y;  // shifted off the ground
            const double height = static_cast<double>(k) * spacing;
            lowest = std::max(lowest, slide.resting_height(x, y, radius) - height);
            state.positions.push_back({x, y, height});
            state.radii.push_back(radius);
        }
        for (std::size_t i = foot; i < state.size(); ++i) state.positions[i].z += lowest;
    });
    if (state.size() == first)
        throw InputError(fmt::format("{}: the spacing of {:.4g} m is too wide for what slides, not one particle fits; give a smaller spacing", place_of(scene, group), spacing));
}

}  // namespace grainray::scene
