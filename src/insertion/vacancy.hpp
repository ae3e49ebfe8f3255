// Where a sphere may be put: clear of particles, planes, meshes and the ground. Everything relative to the world's origin.
#pragma once

#include "insertion/exchange.hpp"
#include "insertion/inlet.hpp"
#include "scene/sphere_grid.hpp"

namespace grainray {

/// Planes, meshes and the ground at one time, on the host.
class Obstacles {
public:
    Obstacles(const Scene& scene, const State& state) : scene_(scene), state_(state), copy_(Device::cpu) {}
    /// As the state has them now, at this time.
    void update(double time);
    bool touch(const Vec3d& centre, double radius) const;

private:
    bool surface_touches(std::uint32_t surface, const Vec3d& centre, double radius) const;
    const Facets& facets() const;

    const Scene& scene_;
    const State& state_;
    std::vector<PlaneState> planes_;
    Facets copy_;  ///< of what a GPU holds
};

class Vacancy {
public:
    /// residents: all that reach into the region.
    Vacancy(const InletRegion&, const std::vector<Resident>&, const Obstacles&, const State&, double largest_radius, std::size_t newcomers);
    /// A sphere at a fixed-point position.
    bool has_room(const Vec3l& position, double radius) const;
    void add(const Vec3l& position, double radius);

private:
    void add_images(const Resident&);

    const Obstacles& obstacles_;
    PositionScale scale_;
    Vec3d period_;
    std::array<bool, 3> wraps_;
    Box box_;
    scene::SphereGrid grid_;
};

}  // namespace grainray
