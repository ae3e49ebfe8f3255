// The two columns against LAMMPS and LIGGGHTS. `expected` is the mean over their runs (A: three seeds each; B: two and one),
// the tolerance covers the scatter of those runs about it; benchmarks/peers/README.md has the runs.
#include "validation/column.hpp"

#include <algorithm>

#include "validation/cases.hpp"

namespace grainray::validation {
namespace {

constexpr const char* peers = "LAMMPS, LIGGGHTS";

/// Energies of the peers at one time, J, and how far grainray may be from them as a share.
struct Energies {
    int step;
    double kinetic, potential, kinetic_tolerance, potential_tolerance;
};
constexpr Energies energies_A[] = {{500, 1.38632e6, 1.10726e7, 0.01, 0.005},  {1000, 3.37033e6, 7.07206e6, 0.01, 0.005},
                                   {1200, 3.15131e6, 5.52563e6, 0.015, 0.005}, {1500, 8.41145e5, 3.99714e6, 0.03, 0.01},
                                   {2000, 7.15238e5, 4.26096e6, 0.03, 0.01},   {3000, 3.12780e5, 2.95479e6, 0.05, 0.02},
                                   {10000, 0, 2.52430e6, 0, 0.02}};
constexpr Energies energies_B[] = {{500, 1.19277e6, 6.60380e6, 0.01, 0.005},  {1000, 1.53295e6, 3.55170e6, 0.01, 0.005},
                                   {1200, 4.04702e5, 2.94850e6, 0.02, 0.005},  {1500, 3.33432e5, 2.94554e6, 0.03, 0.005},
                                   {2000, 2.66551e5, 2.47895e6, 0.03, 0.01},   {3000, 4.49048e4, 2.10576e6, 0.05, 0.01},
                                   {8000, 0, 1.99107e6, 0, 0.01}};

/// Figures of the deposits of the peers; 0: shown, not gated.
struct Figure {
    const char* name;
    double Deposit::*value;
    double expected, tolerance;
    bool relative;
};
constexpr Figure deposit_A[] = {{"x_edge, m", &Deposit::x_edge, 23.458, 0.015, true},       {"x_95, m", &Deposit::x_95, 20.536, 0.02, true},
                                {"x_99, m", &Deposit::x_99, 24.561, 0.02, true},            {"h_wall, m", &Deposit::h_wall, 4.700, 0.03, true},
                                {"z_mean, m", &Deposit::z_mean, 1.4946, 0.02, true},        {"angle_secant, deg", &Deposit::angle_secant, 11.330, 0.4, false},
                                {"angle_steep, deg", &Deposit::angle_steep, 16.532, 0, false}};
constexpr Figure deposit_B[] = {{"x_edge, m", &Deposit::x_edge, 12.332, 0.015, true},       {"x_95, m", &Deposit::x_95, 11.640, 0.02, true},
                                {"x_99, m", &Deposit::x_99, 15.722, 0, false},              {"h_wall, m", &Deposit::h_wall, 3.818, 0.03, true},
                                {"z_mean, m", &Deposit::z_mean, 1.2002, 0.01, true},        {"angle_secant, deg", &Deposit::angle_secant, 17.203, 0.4, false},
                                {"angle_steep, deg", &Deposit::angle_steep, 21.608, 0, false}};
struct Lines {
    double top, mass;
};
constexpr Lines angles_A{9.145, 10.094}, angles_B{15.212, 17.190};

/// Runs to the last of `steps`, comparing energies on the way.
template <std::size_t n>
Simulation run(Report& report, const Column& column, const Energies (&energies)[n], int steps) {
    const Scene scene = column_scene(column, 1);
    Simulation s(scene, place_particles(scene), report.options);
    for (const Energies& e : energies) {
        if (e.step > steps) break;
        s.run(static_cast<std::uint64_t>(e.step) - s.step_count());
        s.check_health();
        const Statistics now = s.statistics();
        const std::string at = " at " + std::to_string(e.step / 1000) + "." + std::to_string(e.step % 1000 / 100) + " s, J";
        if (e.kinetic > 0) report.relative("kinetic energy" + at, e.kinetic, now.kinetic_translation, e.kinetic_tolerance, peers);
        report.relative("potential energy" + at, e.potential, now.potential, e.potential_tolerance, peers);
    }
    return s;
}

template <std::size_t n>
void deposit(Report& report, const Column& column, const Simulation& s, const Figure (&figures)[n], const Lines& lines) {
    const Deposit d = measure(s.frame().position, column.channel());
    for (const Figure& f : figures) {
        if (f.tolerance == 0) report.shown(f.name, f.expected, d.*f.value, peers);
        else if (f.relative) report.relative(f.name, f.expected, d.*f.value, f.tolerance, peers);
        else report.absolute(f.name, f.expected, d.*f.value, f.tolerance, peers);
    }
    report.absolute("angle_top, deg", lines.top, d.top.angle, 0.6, peers);
    report.absolute("angle_mass, deg", lines.mass, d.mass.angle, 0.6, peers);
}

}  // namespace

Scene column_scene(const Column& c, std::uint64_t seed) {
    Scene s;
    s.title = "column collapse, stable reading";
    s.dt = 1e-3;
    s.seed = seed;
    s.contact.mass_damping = 0.1;
    s.materials = {{"grain", 2000, 1e5, 1e5, 0.5, 0.5, 0}, {"wall", 2000, 1e7, 2e7 / 7, 1.0, 0.5, 0}, {"side", 2000, 1e7, 2e7 / 7, c.side_friction, 0.5, 0}};
    const double a = c.spacing(), half = a / 2, shift = 0.1 * c.radius;
    s.particles = {{"column", "grain", Lattice{{c.nx, c.ny, c.nz}, {a, a, a}, {half, half, half}, {shift, shift, 0}},
                    {SizeLaw::fixed, c.radius, 0, 0, 0, 0, {}, {}}, {}, {}}};
    s.planes = {{"floor", "wall", {}, {0, 0, 1}, {}},
                {"back", "wall", {}, {1, 0, 0}, {}},
                {"side 1", "side", {}, {0, 1, 0}, {}},
                {"side 2", "side", {0, c.width(), 0}, {0, -1, 0}, {}}};
    return s;
}

void column_a_start(Report& report) { run(report, column_A, energies_A, 2000); }
void column_b_start(Report& report) { run(report, column_B, energies_B, 2000); }
void column_a(Report& report) { deposit(report, column_A, run(report, column_A, energies_A, 10000), deposit_A, angles_A); }
void column_b(Report& report) { deposit(report, column_B, run(report, column_B, energies_B, 8000), deposit_B, angles_B); }

}  // namespace grainray::validation
