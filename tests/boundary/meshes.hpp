// Meshes the tests make, and scenes on them.
#pragma once

#include <algorithm>
#include <random>

#include "../simulation/scenes.hpp"

namespace grainray::test {

/// Equal numbers everywhere: the standard library's distributions differ.
struct Dice {
    std::mt19937_64 engine;
    explicit Dice(std::uint64_t seed) : engine(seed) {}
    double operator()() { return static_cast<double>(engine() >> 11) * 0x1p-53; }
    double operator()(double lower, double upper) { return lower + (upper - lower) * (*this)(); }
};

/// A square of side 2 half in z = 0 of 2 n^2 triangles; n > 1: at random places, of random diagonals, order and sense.
inline TriangleMesh square(double half, int n, std::uint64_t seed = 3) {
    Dice u(seed);
    TriangleMesh m;
    const double edge = 2 * half / n;
    const auto index = [n](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const double shift = n > 1 ? 0.24 * edge : 0, x = i > 0 && i < n ? u(-shift, shift) : 0, y = j > 0 && j < n ? u(-shift, shift) : 0;
            m.vertices.push_back({-half + i * edge + x, -half + j * edge + y, 0});
        }
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const std::uint32_t a = index(i, j), b = index(i + 1, j), c = index(i + 1, j + 1), d = index(i, j + 1);
            const bool other = n > 1 && u() < 0.5;
            m.triangles.push_back(other ? std::array{a, b, d} : std::array{a, b, c});
            m.triangles.push_back(other ? std::array{b, c, d} : std::array{a, c, d});
        }
    for (auto& t : m.triangles)
        if (n > 1 && u() < 0.5) std::swap(t[0], t[1]);
    if (n > 1) std::shuffle(m.triangles.begin(), m.triangles.end(), u.engine);
    return m;
}

/// One triangle that holds the square.
inline TriangleMesh one_triangle(double half) {
    return {{{-4 * half, -2 * half, 0}, {4 * half, -2 * half, 0}, {0, 6 * half, 0}}, {{0, 1, 2}}};
}

/// A box, its faces outwards; n^2 squares a face.
inline TriangleMesh box(const Vec3d& lower, const Vec3d& upper, int n = 1) {
    TriangleMesh m;
    for (int axis = 0; axis < 3; ++axis)
        for (int top = 0; top < 2; ++top) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i) {
                    const auto corner = [&](int p, int q) {
                        Vec3d x;
                        x[axis] = top ? upper[axis] : lower[axis];
                        x[u] = lower[u] + (upper[u] - lower[u]) * (i + p) / n;
                        x[v] = lower[v] + (upper[v] - lower[v]) * (j + q) / n;
                        m.vertices.push_back(x);
                        return static_cast<std::uint32_t>(m.vertices.size() - 1);
                    };
                    const std::uint32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
                    if (top) m.triangles.push_back({a, b, c}), m.triangles.push_back({a, c, d});
                    else m.triangles.push_back({a, c, b}), m.triangles.push_back({a, d, c});
                }
        }
    return m;
}

inline void add_mesh(Case& c, TriangleMesh geometry, const std::string& name = "mesh") {
    Mesh mesh;
    mesh.name = name;
    mesh.material = "wall";
    mesh.geometry = std::move(geometry);
    c.scene.meshes.push_back(std::move(mesh));
}

inline double energy(const Statistics& s) { return s.kinetic_translation + s.kinetic_rotation + s.potential; }

}  // namespace grainray::test
