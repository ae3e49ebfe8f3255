// Streams and removals by struct.
#pragma once

#include <map>

#include "devices.hpp"
#include "simulation/scenes.hpp"

namespace grainray::test {

inline ParticleStream box_stream(const std::string& name, const Box& box, double rate, double radius = 0.1) {
    ParticleStream s;
    s.name = name;
    s.material = "grain";
    s.inlet = box;
    s.rate.particles = rate;
    s.size.radius = radius;
    s.velocity = {0, 0, -2};
    return s;
}

inline Removal half_space(const std::string& name, const Vec3d& point, const Vec3d& normal, std::int64_t steps = 100) {
    Removal r;
    r.name = name;
    r.region = RemovalRegion::half_space;
    r.point = point;
    r.normal = normal;
    r.steps = steps;
    return r;
}

/// Grains of many sizes rain on a floor between walls; those that get over its edge at x = 2 fall and are taken out.
inline Case fountain() {
    Case c = empty_case();
    c.scene.dt = 4e-4;
    c.scene.duration = 2;
    c.scene.materials[0].normal_stiffness = c.scene.materials[0].tangential_stiffness = 1e4;
    c.scene.materials[1].normal_stiffness = c.scene.materials[1].tangential_stiffness = 2e4;
    c.plane("floor", {0, 0, 0}, {0, 0, 1});
    c.plane("back", {0, 0, 0}, {1, 0, 0});
    c.plane("left", {0, 0, 0}, {0, 1, 0});
    c.plane("right", {0, 1, 0}, {0, -1, 0});
    ParticleStream s = box_stream("rain", {{0.1, 0.1, 1.2}, {0.9, 0.9, 1.8}}, 400);
    s.size = {SizeLaw::uniform, 0, 0.05, 0.1, 0, 0, {}, {}};
    s.velocity = {1, 0, -2};
    s.velocity_spread = {0.5, 0.5, 0.5};
    c.scene.streams.push_back(s);
    c.scene.removals.push_back(half_space("edge", {1.6, 0, 0}, {1, 0, 0}, 50));
    for (int k = 0; k < 5; ++k) c.add({0.2 + 0.2 * k, 0.5, 0.09}, 0.09);
    return c;
}

/// Smallest distance between the surfaces of two particles, over the smaller radius.
inline double smallest_gap(const Frame& f, std::size_t first_of_interest = 0) {
    double gap = 1e300;
    for (std::size_t i = 0; i < f.size(); ++i)
        for (std::size_t j = std::max(i + 1, first_of_interest); j < f.size(); ++j)
            gap = std::min(gap, (length(f.position[i] - f.position[j]) - f.radius[i] - f.radius[j]) / std::min(f.radius[i], f.radius[j]));
    return gap;
}

inline double total_mass(const Frame& f) {
    double sum = 0;
    for (const float m : f.mass) sum += m;
    return sum;
}

}  // namespace grainray::test
