// Scene -> the particles at the start, group after group.
#include "scene/place.hpp"

#include <fmt/format.h>

#include <cmath>

namespace grainray {
namespace scene {
namespace {

void place_lattice(const Scene& scene, const ParticleGroup& group, const Lattice& lattice, InitialState& state) {
    const RadiusSampler radius(group.size, scene.seed, group.name, place_of(scene, group));
    const Random random(scene.seed, group.name, Stream::jitter);
    const auto [nx, ny, nz] = lattice.count;
    const auto total = static_cast<std::size_t>(nx * ny * nz);
    state.positions.reserve(state.size() + total);
    state.radii.reserve(state.size() + total);
    std::uint64_t n = 0;
    for (std::int64_t k = 0; k < nz; ++k)
        for (std::int64_t j = 0; j < ny; ++j)
            for (std::int64_t i = 0; i < nx; ++i, ++n) {
                const Vec3d index{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
                Vec3d x;
                for (int axis = 0; axis < 3; ++axis)
                    x[axis] = lattice.origin[axis] + index[axis] * lattice.spacing[axis] +
                              lattice.jitter[axis] * random.uniform(3 * n + static_cast<std::uint64_t>(axis));
                state.positions.push_back(x);
                state.radii.push_back(radius(n));
            }
}

void place_list(const ParticleList& list, InitialState& state) {
    const std::size_t n = list.positions.size();
    state.positions.insert(state.positions.end(), list.positions.begin(), list.positions.end());
    if (list.radii.size() == 1) state.radii.insert(state.radii.end(), n, list.radii.front());
    else state.radii.insert(state.radii.end(), list.radii.begin(), list.radii.end());
    state.velocities.insert(state.velocities.end(), list.velocities.begin(), list.velocities.end());
    state.angular_velocities.insert(state.angular_velocities.end(), list.angular_velocities.begin(),
                                    list.angular_velocities.end());
}

std::uint32_t material_index(const Scene& scene, const ParticleGroup& group) {
    for (std::size_t m = 0; m < scene.materials.size(); ++m)
        if (scene.materials[m].name == group.material) return static_cast<std::uint32_t>(m);
    throw InputError(fmt::format("{} = \"{}\": unknown material", place_of(scene, group, "material"), group.material));
}

/// Wraps along periodic axes; throws for a particle outside the domain along another.
void into_domain(const Scene& scene, const ParticleGroup& group, std::size_t first, InitialState& state) {
    if (!scene.domain.box) return;
    const Box& box = *scene.domain.box;
    for (std::size_t i = first; i < state.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) {
            double& x = state.positions[i][axis];
            if (x >= box.lower[axis] && x < box.upper[axis]) continue;
            if (!scene.domain.periodic[static_cast<std::size_t>(axis)]) {
                if (x == box.upper[axis]) continue;
                throw InputError(
                    fmt::format("{}: particle {} of the group is outside the domain ({} = {} m, domain {} to {} m); "
                                "enlarge the domain or move the group",
                                place_of(scene, group), i - first, "xyz"[axis], x, box.lower[axis], box.upper[axis]));
            }
            const double period = box.extent()[axis];
            x -= period * std::floor((x - box.lower[axis]) / period);
            if (!(x >= box.lower[axis] && x < box.upper[axis])) x = box.lower[axis];  // rounded to the upper end
        }
}

void place_group(const Scene& scene, const ParticleGroup& group, InitialState& state) {
    const std::size_t first = state.size();
    const std::uint32_t material = material_index(scene, group);
    if (const auto* lattice = std::get_if<Lattice>(&group.placement)) place_lattice(scene, group, *lattice, state);
    else if (const auto* list = std::get_if<ParticleList>(&group.placement)) place_list(*list, state);
    else if (const auto* file = std::get_if<ParticleFile>(&group.placement)) place_file(scene, group, *file, state);
    else if (const auto* release = std::get_if<Release>(&group.placement)) place_release(scene, group, *release, state);
    else place_fill(scene, group, std::get<RandomFill>(group.placement), state);
    if (state.size() > std::size_t{1} << 31)
        throw InputError(fmt::format("{}: {} particles are too many; at most 2^31 = 2147483648", place_of(scene, group),
                                     state.size()));
    state.velocities.resize(state.size(), group.velocity);
    state.angular_velocities.resize(state.size(), group.angular_velocity);
    state.materials.resize(state.size(), material);
    into_domain(scene, group, first, state);
}

}  // namespace

std::string place_of(const Scene& scene, const ParticleGroup& group, const std::string& field) {
    const std::string file = scene.file.empty() ? "scene" : scene.file.string();
    return fmt::format("{}: key 'particles.{}{}{}'", file, group.name, field.empty() ? "" : ".", field);
}

}  // namespace scene

InitialState place_particles(const Scene& scene) {
    InitialState state;
    for (const ParticleGroup& group : scene.particles) scene::place_group(scene, group, state);
    return state;
}

}  // namespace grainray
