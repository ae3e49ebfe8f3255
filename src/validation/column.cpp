// The two columns against LAMMPS and LIGGGHTS. `expected` is the mean over their runs (A: eight seeds each; B: energies eight
// each, deposit two and one), the tolerance covers the scatter of those runs about it and, for three of ours, three standard
// errors (one run of B at 3 s scatters by 4 % in kinetic energy); benchmarks/peers/README.md has the runs. Peers write energies with
// full-step velocities, grainray with half-step ones: up to 0.3 % of the kinetic energy while it changes fastest.
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
constexpr Energies energies_A[] = {{500, 1.38485e6, 1.10734e7, 0.01, 0.005},  {1000, 3.37216e6, 7.07161e6, 0.01, 0.005},
                                   {1200, 3.15251e6, 5.52446e6, 0.015, 0.005}, {1500, 8.43056e5, 3.99885e6, 0.03, 0.01},
                                   {2000, 7.12057e5, 4.26250e6, 0.03, 0.01},   {3000, 3.12293e5, 2.95729e6, 0.05, 0.02},
                                   {10000, 0, 2.51741e6, 0, 0.02}};
constexpr Energies energies_B[] = {{500, 1.19094e6, 6.60485e6, 0.01, 0.005},  {1000, 1.53377e6, 3.55232e6, 0.01, 0.005},
                                   {1200, 4.05446e5, 2.94835e6, 0.02, 0.005},  {1500, 3.35275e5, 2.94439e6, 0.03, 0.005},
                                   {2000, 2.68576e5, 2.47524e6, 0.04, 0.01},   {3000, 4.59672e4, 2.10055e6, 0.075, 0.01},
                                   {8000, 0, 1.99107e6, 0, 0.01}};

/// Figures of the deposits of the peers; 0: shown, not gated.
struct Figure {
    const char* name;
    double Deposit::*value;
    double expected, tolerance;
    bool relative;
};
constexpr Figure deposit_A[] = {
    {"x_edge, m", &Deposit::x_edge, 23.414, 0.01, true},           {"x_95, m", &Deposit::x_95, 20.515, 0.01, true},
    {"x_99, m", &Deposit::x_99, 24.507, 0.01, true},               {"h_wall, m", &Deposit::h_wall, 4.708, 0.03, true},
    {"z_mean, m", &Deposit::z_mean, 1.4905, 0.02, true},           {"angle_secant, deg", &Deposit::angle_secant, 11.370, 0.3, false},
    {"angle_top, deg", &Deposit::angle_top, 9.092, 0.4, false},    {"angle_mass, deg", &Deposit::angle_mass, 9.933, 0.7, false},
    {"angle_steep, deg", &Deposit::angle_steep, 16.31, 0, false}};
constexpr Figure deposit_B[] = {
    {"x_edge, m", &Deposit::x_edge, 12.332, 0.01, true},           {"x_95, m", &Deposit::x_95, 11.640, 0.01, true},
    {"x_99, m", &Deposit::x_99, 15.722, 0, false},                 {"h_wall, m", &Deposit::h_wall, 3.818, 0.03, true},
    {"z_mean, m", &Deposit::z_mean, 1.2002, 0.01, true},           {"angle_secant, deg", &Deposit::angle_secant, 17.203, 0.3, false},
    {"angle_top, deg", &Deposit::angle_top, 15.212, 0.4, false},   {"angle_mass, deg", &Deposit::angle_mass, 17.189, 0.6, false},
    {"angle_steep, deg", &Deposit::angle_steep, 21.61, 0, false}};

/// What the runs of several seeds have in common: the flow is chaotic, one run says little about the next.
struct Means {
    std::vector<double> kinetic, potential;
    Deposit deposit{};
};

constexpr double Deposit::*deposit_fields[] = {&Deposit::x_edge, &Deposit::x_toe, &Deposit::x_50, &Deposit::x_95, &Deposit::x_99, &Deposit::x_max,
                                               &Deposit::z_mean, &Deposit::h_wall, &Deposit::angle_secant, &Deposit::angle_top,
                                               &Deposit::r2_top, &Deposit::angle_mass, &Deposit::r2_mass, &Deposit::angle_steep};

template <std::size_t n>
Means run(const SimulationOptions& options, const Column& column, const Energies (&energies)[n], int steps, int seeds) {
    Means mean{std::vector<double>(n), std::vector<double>(n), {}};
    for (int seed = 1; seed <= seeds; ++seed) {
        const Scene scene = column_scene(column, static_cast<std::uint64_t>(seed));
        Simulation s(scene, place_particles(scene), options);
        for (std::size_t k = 0; k < n && energies[k].step <= steps; ++k) {
            s.run(static_cast<std::uint64_t>(energies[k].step) - s.step_count());
            s.check_health();
            mean.kinetic[k] += s.statistics().kinetic_translation / seeds;
            mean.potential[k] += s.statistics().potential / seeds;
        }
        const Deposit d = measure(s.frame().position, column.channel());
        for (const auto field : deposit_fields) mean.deposit.*field += d.*field / seeds;
    }
    return mean;
}

template <std::size_t n>
void compare_energies(Report& report, const Means& mean, const Energies (&energies)[n], int steps) {
    for (std::size_t k = 0; k < n && energies[k].step <= steps; ++k) {
        const Energies& e = energies[k];
        const std::string at = " at " + std::to_string(e.step / 1000) + "." + std::to_string(e.step % 1000 / 100) + " s, J";
        if (e.kinetic > 0) report.relative("kinetic energy" + at, e.kinetic, mean.kinetic[k], e.kinetic_tolerance, peers);
        report.relative("potential energy" + at, e.potential, mean.potential[k], e.potential_tolerance, peers);
    }
}

template <std::size_t n>
void compare_deposit(Report& report, const Deposit& d, const Figure (&figures)[n]) {
    for (const Figure& f : figures) {
        if (f.tolerance == 0) report.shown(f.name, f.expected, d.*f.value, peers);
        else if (f.relative) report.relative(f.name, f.expected, d.*f.value, f.tolerance, peers);
        else report.absolute(f.name, f.expected, d.*f.value, f.tolerance, peers);
    }
}

template <std::size_t n>
void start(Report& report, const Column& column, const Energies (&energies)[n]) {
    compare_energies(report, run(report.options, column, energies, 2000, 1), energies, 2000);
}

template <std::size_t n, std::size_t m>
void whole(Report& report, const Column& column, const Energies (&energies)[n], const Figure (&figures)[m], int steps, int seeds) {
    const Means mean = run(report.options, column, energies, steps, seeds);
    compare_energies(report, mean, energies, steps);
    compare_deposit(report, mean.deposit, figures);
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

void column_a_start(Report& report) { start(report, column_A, energies_A); }
void column_b_start(Report& report) { start(report, column_B, energies_B); }
void column_a(Report& report) { whole(report, column_A, energies_A, deposit_A, 10000, 3); }
void column_b(Report& report) { whole(report, column_B, energies_B, deposit_B, 8000, 3); }

}  // namespace grainray::validation
