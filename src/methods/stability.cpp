// How long a time step each kind of contact bears under the explicit scheme (symplectic Euler, damping lagged by a step).
//
// A mode with stiffness k, damping c and effective mass m obeys v' = v - dt (k x + c v) / m, x' = x + dt v'; its
// characteristic polynomial is stable while (k/m) dt^2 + 2 (c/m) dt < 4, so dt_c = (sqrt(c^2 + 4 k m) - c) / k.
// Modes looked at, for the lightest particles of each material:
//   pair, normal       1/m = 1/m_a + 1/m_b
//   pair, tangential   1/m = 3.5 (1/m_a + 1/m_b): rolling adds r^2 / I = 2.5 / m
//   wall               the same with the wall's mass infinite
//   bed, tangential    a grain that spins against 6 neighbours that spin against it: 6 contacts, 2/3 of them across the
//   bed, normal        axis, each stretched twice as fast; and the like for shaking, with all springs
#include <algorithm>
#include <cmath>
#include <map>

#include "grainray/simulation.hpp"

namespace grainray {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double bed_contacts = 6;     // mean number of contacts of a frictionless random packing
constexpr double spin_mass = 2.5;      // m r^2 / I of a sphere

double critical_dt(double k, double c, double m) {
    return k > 0 ? (std::sqrt(c * c + 4 * k * m) - c) / k : c > 0 ? 2 * m / c : INFINITY;
}

struct Sizes {
    double lightest = INFINITY, heaviest = 0;
};

struct Finder {
    const Scene& scene;
    std::vector<CriticalStep> found;

    /// The scene key behind a contact: a pair row if there is one, else the boundary's or the stiffer material.
    std::string key(std::size_t a, std::size_t b, bool wall, bool normal, bool damping) const {
        const char* name = damping ? (normal ? "normal_damping" : "tangential_damping") : (normal ? "normal_stiffness" : "tangential_stiffness");
        const Material &ma = scene.materials[a], &mb = scene.materials[b];
        for (std::size_t row = 0; row < scene.pairs.size(); ++row) {
            const auto& m = scene.pairs[row].materials;
            if ((m[0] == ma.name && m[1] == mb.name) || (m[0] == mb.name && m[1] == ma.name)) return "pairs[" + std::to_string(row) + "]." + name;
        }
        const auto value = [&](const Material& m) {
            return damping ? (normal ? m.normal_damping : m.tangential_damping) : (normal ? m.normal_stiffness : m.tangential_stiffness);
        };
        const bool second = (wall && scene.contact.mixing == Mixing::wall) || value(mb) > value(ma);
        return "materials." + (second ? mb.name : ma.name) + "." + name;
    }

    void add(const std::string& what, std::size_t a, std::size_t b, bool wall, bool normal, double k, double c, double m) {
        const double dt = critical_dt(k, c, m);
        if (!std::isfinite(dt)) return;
        found.push_back({what, dt, key(a, b, wall, normal, 2 * c / m * dt > k / m * dt * dt)});
    }

    void pair(std::size_t a, std::size_t b, const MaterialPair& p, double mass_a, double mass_b, bool wall, const std::string& names) {
        const double mean = wall ? mass_a : 0.5 * (mass_a + mass_b), reduced = wall ? mass_a : mass_a * mass_b / (mass_a + mass_b);
        const double cn = 2 * p.normal_damping * std::sqrt(mean * p.normal_stiffness);
        const double ct = 2 * p.tangential_damping * std::sqrt(mean * p.tangential_stiffness);
        add(names + ", normal", a, b, wall, true, p.normal_stiffness, cn, reduced);
        if (p.friction > 0) add(names + ", tangential", a, b, wall, false, p.tangential_stiffness, ct, reduced / (1 + spin_mass));
        if (wall) return;
        const double springs = 2 * bed_contacts / 3;
        const bool stiff = p.friction > 0;
        add(names + ", bed of 6 contacts, normal", a, b, wall, true, springs * (p.normal_stiffness + (stiff ? 2 * p.tangential_stiffness : 0)),
            springs * (cn + (stiff ? 2 * ct : 0)), mass_a);
        if (stiff) add(names + ", bed of 6 contacts, tangential", a, b, wall, false, 2 * springs * p.tangential_stiffness, 2 * springs * ct, mass_a / spin_mass);
    }
};

}  // namespace

std::vector<CriticalStep> critical_steps(const Scene& scene, const InitialState& particles) {
    std::map<std::size_t, Sizes> sizes;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const std::size_t m = particles.materials[i];
        const double r = particles.radii[i], mass = 4.0 / 3.0 * pi * r * r * r * scene.materials[m].density;
        sizes[m].lightest = std::min(sizes[m].lightest, mass);
        sizes[m].heaviest = std::max(sizes[m].heaviest, mass);
    }
    for (const ParticleStream& stream : scene.streams)
        for (std::size_t m = 0; m < scene.materials.size(); ++m) {
            if (scene.materials[m].name != stream.material) continue;
            const auto mass = [&](double r) { return 4.0 / 3.0 * pi * r * r * r * scene.materials[m].density; };
            sizes[m].lightest = std::min(sizes[m].lightest, mass(smallest_radius(stream.size)));
            sizes[m].heaviest = std::max(sizes[m].heaviest, mass(largest_radius(stream.size)));
        }
    Finder finder{scene, {}};
    for (const auto& [a, sa] : sizes) {
        for (const auto& [b, sb] : sizes) {
            if (b < a) continue;
            const MaterialPair p = contact_parameters(scene, a, b, false);
            const std::string names = scene.materials[a].name + "-" + scene.materials[b].name;
            finder.pair(a, b, p, sa.lightest, sb.lightest, false, names);
            if (sb.heaviest > sb.lightest) finder.pair(a, b, p, sa.lightest, sb.heaviest, false, names + " (lightest, heaviest)");
        }
        for (std::size_t b = 0; b < scene.materials.size(); ++b)
            for (const Plane& plane : scene.planes) {
                if (plane.material != scene.materials[b].name) continue;
                finder.pair(a, b, contact_parameters(scene, a, b, true), sa.lightest, 0, true, scene.materials[a].name + "-" + scene.materials[b].name + " plane");
                break;
            }
        const auto surface = [&](const std::string& material, const std::string& what) {
            for (std::size_t b = 0; b < scene.materials.size(); ++b)
                if (scene.materials[b].name == material)
                    finder.pair(a, b, contact_parameters(scene, a, b, true), sa.lightest, 0, true, scene.materials[a].name + "-" + material + " " + what);
        };
        for (const Mesh& mesh : scene.meshes) surface(mesh.material, "mesh " + mesh.name);
        if (scene.terrain) surface(scene.terrain->material, "terrain");
    }
    std::stable_sort(finder.found.begin(), finder.found.end(), [](const auto& x, const auto& y) { return x.critical_dt < y.critical_dt; });
    return finder.found;
}

}  // namespace grainray
