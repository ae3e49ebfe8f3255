// Random non-overlapping fill of a box: random sequential insertion, largest first.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numbers>

#include "scene/place.hpp"
#include "scene/sphere_grid.hpp"

namespace grainray::scene {
namespace {

constexpr std::size_t most_particles = std::size_t{1} << 31;
constexpr std::uint64_t most_attempts =
    20000;  // a particle; near the jamming limit of random insertion hardly any succeeds

double volume_of(double radius) { return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius; }
double volume_of(const Box& box) { return box.extent().x * box.extent().y * box.extent().z; }

/// The radii wanted, largest first: `count` of them, or as many as reach the solid fraction.
std::vector<double> wanted_radii(const RandomFill& fill, const RadiusSampler& sampler, const std::string& where) {
    std::vector<double> radii;
    const double target = fill.solid_fraction * volume_of(fill.box);
    const bool by_count = fill.solid_fraction <= 0;
    const auto too_many = [&] {
        throw InputError(fmt::format(
            "{}: the fill needs more than 2^31 particles; lower solid_fraction or take larger radii", where));
    };
    if (!by_count && target / volume_of(sampler.largest()) > static_cast<double>(most_particles)) too_many();
    for (double volume = 0; by_count ? radii.size() < static_cast<std::size_t>(fill.count) : volume < target;) {
        if (radii.size() == most_particles) too_many();
        radii.push_back(sampler(radii.size()));
        volume += volume_of(radii.back());
    }
    std::sort(radii.begin(), radii.end(), std::greater<>());
    return radii;
}

/// The whole box is periodic along an axis when it spans the domain there; elsewhere spheres stay wholly inside.
std::array<bool, 3> wrapped_axes(const Domain& domain, const Box& box) {
    std::array<bool, 3> wraps{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        wraps[a] = domain.periodic[a] && domain.box && box.lower[axis] == domain.box->lower[axis] &&
                   box.upper[axis] == domain.box->upper[axis];
    }
    return wraps;
}

/// A random centre such that the sphere lies in the box.
Vec3d random_centre(const Box& box, const std::array<bool, 3>& wraps, double radius, const Random& random,
                    std::uint64_t attempt) {
    Vec3d centre;
    for (int axis = 0; axis < 3; ++axis) {
        const double inset = wraps[static_cast<std::size_t>(axis)] ? 0 : radius;
        const double lower = box.lower[axis] + inset, upper = box.upper[axis] - inset;
        centre[axis] =
            std::min(lower + (upper - lower) * random.uniform(3 * attempt + static_cast<std::uint64_t>(axis)), upper);
    }
    return centre;
}

[[noreturn]] void give_up(const std::string& where, const RandomFill& fill, const std::vector<double>& radii,
                          std::size_t placed) {
    double reached = 0, wanted = 0;
    for (std::size_t i = 0; i < radii.size(); ++i) {
        wanted += volume_of(radii[i]);
        if (i < placed) reached += volume_of(radii[i]);
    }
    const double box = volume_of(fill.box);
    throw InputError(
        fmt::format("{}: random insertion placed {} of {} particles, a solid fraction of {:.3f} of {:.3f} wanted. It "
                    "reaches about 0.32 for equal spheres: lower {}, enlarge the box, or let a looser fill settle",
                    where, placed, radii.size(), reached / box, wanted / box,
                    fill.solid_fraction > 0 ? "solid_fraction" : "count"));
}

}  // namespace

void place_fill(const Scene& scene, const ParticleGroup& group, const RandomFill& fill, InitialState& state) {
    const std::string where = place_of(scene, group);
    const RadiusSampler sampler(group.size, scene.seed, group.name, where);
    const Random random(scene.seed, group.name, Stream::fill);
    const std::vector<double> radii = wanted_radii(fill, sampler, where);
    if (radii.empty()) return;
    const Vec3d extent = fill.box.extent();
    if (2 * radii.front() > std::min({extent.x, extent.y, extent.z}))
        throw InputError(fmt::format("{}: a particle of radius {} m does not fit into the box of {} x {} x {} m", where,
                                     radii.front(), extent.x, extent.y, extent.z));

    const auto wraps = wrapped_axes(scene.domain, fill.box);
    SphereGrid grid(fill.box, wraps, radii.front(), radii.size());
    std::uint64_t attempt = 0;
    for (std::size_t i = 0; i < radii.size(); ++i) {
        const std::uint64_t last = attempt + most_attempts;
        Vec3d centre = random_centre(fill.box, wraps, radii[i], random, attempt++);
        while (grid.overlaps(centre, radii[i])) {
            if (attempt == last) give_up(where, fill, radii, i);
            centre = random_centre(fill.box, wraps, radii[i], random, attempt++);
        }
        grid.insert(centre, radii[i]);
        state.positions.push_back(centre);
        state.radii.push_back(radii[i]);
    }
}

}  // namespace grainray::scene
