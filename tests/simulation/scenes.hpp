// Small scenes by struct, in the stable reading of the column.
#pragma once

#include <random>

#include "grainray/simulation.hpp"

namespace grainray::test {

struct Case {
    Scene scene;
    InitialState initial;

    void add(Vec3d x, double r, Vec3d v = {}, Vec3d w = {}, std::uint32_t material = 0) {
        initial.positions.push_back(x);
        initial.radii.push_back(r);
        initial.velocities.push_back(v);
        initial.angular_velocities.push_back(w);
        initial.materials.push_back(material);
    }
    void plane(const std::string& name, Vec3d point, Vec3d normal) { scene.planes.push_back({name, "wall", point, normal, {}}); }
    Simulation start(Device device = Device::cpu, const std::string& backend = "cells", int threads = 0) const {
        return Simulation(scene, initial, {device, backend, threads});
    }
};

inline Case empty_case() {
    Case c;
    c.scene.dt = 1e-3;
    c.scene.duration = 1;
    c.scene.contact.mass_damping = 0.1;
    c.scene.materials.resize(2);
    c.scene.materials[0].name = "grain";
    Material& wall = c.scene.materials[1];
    wall.name = "wall";
    wall.normal_stiffness = 1e7;
    wall.tangential_stiffness = 2.0 / 7.0 * 1e7;
    wall.friction = 1;
    return c;
}

/// A dense column with a random shift, thrown sideways so that it lands hard and mixes.
inline Case column(int nx, int ny, int nz, double ratio = 1) {
    Case c = empty_case();
    if (ratio > 1) {  // light grains want soft springs
        c.scene.dt = 4e-4;
        c.scene.materials[0].normal_stiffness = c.scene.materials[0].tangential_stiffness = 2e3;
        c.scene.materials[1].normal_stiffness = c.scene.materials[1].tangential_stiffness = 2e4;
    }
    std::mt19937_64 e(7);
    const auto u = [&] { return static_cast<double>(e() >> 11) * 0x1p-53; };
    for (int k = 0; k < nz; ++k)
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i) {
                const double x = (i + 0.5) * 0.22 + 0.01 * u(), y = (j + 0.5) * 0.22 + 0.01 * u(), z = (k + 0.5) * 0.22;
                const double r = 0.1 / (1 + (ratio - 1) * u());
                c.add({x, y, z}, r, {2 * u(), u() - 0.5, -3 * u()});
            }
    c.plane("floor", {0, 0, 0}, {0, 0, 1});
    c.plane("back", {0, 0, 0}, {1, 0, 0});
    c.plane("left", {0, 0, 0}, {0, 1, 0});
    c.plane("right", {0, ny * 0.22, 0}, {0, -1, 0});
    return c;
}

/// The column without side walls, periodic in y.
inline Case periodic_column(int nx, int ny, int nz) {
    Case c = column(nx, ny, nz);
    c.scene.planes.resize(2);
    c.scene.domain.box = Box{{-1, 0, -1}, {30, ny * 0.22, 30}};
    c.scene.domain.periodic = {false, true, false};
    return c;
}

inline std::uint64_t hash_after(const Case& c, std::uint64_t steps, Device device = Device::cpu, const std::string& backend = "cells", int threads = 0) {
    Simulation s = c.start(device, backend, threads);
    s.run(steps);
    s.check_health();
    return s.state_hash();
}

}  // namespace grainray::test
