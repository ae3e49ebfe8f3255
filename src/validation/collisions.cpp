// Collisions of spheres with planes and with each other: one dashpot, one friction spring at a time.
#include "validation/cases.hpp"

namespace grainray::validation {
namespace {

/// Spring and dashpot of damping ratio zeta, force kept while the spheres overlap: restitution and duration.
double restitution(double zeta) { return std::exp(-pi * zeta / std::sqrt(1 - zeta * zeta)); }
double duration(double zeta, double mass, double stiffness) { return pi / (std::sqrt(stiffness / mass) * std::sqrt(1 - zeta * zeta)); }

/// Runs both until `steps`, counting the steps with a contact.
int run_counting(Simulation& s, Yardstick& y, int steps) {
    int touching = 0;
    for (int k = 0; k < steps; ++k) {
        s.step();
        y.step();
        touching += s.statistics().contacts > 0;
    }
    return touching;
}

double kinetic(const Statistics& s) { return s.kinetic_translation + s.kinetic_rotation; }

/// Momentum and angular momentum after against before, as a share of the largest that either sphere carries.
void conserved(Report& report, const Statistics& before, const Statistics& after, double momentum, double angular) {
    report.absolute("change of momentum / m v", 0, length(after.momentum - before.momentum) / momentum, 1e-6, "conservation");
    report.absolute("change of angular momentum / m v r", 0, length(after.angular_momentum - before.angular_momentum) / angular, 1e-6,
                    "conservation");
}

}  // namespace

void bounce_on_plane(Report& report) {
    for (const double beta : {0.0, 0.1, 0.5}) {
        const double dt = 2e-5;
        Trial t(dt, {}, {1e5, 0, 0, beta, 0});
        t.plane({}, {0, 0, 1});
        t.sphere({0, 0, 0.1}, {0, 0, -1});
        Simulation s = t.start(report);
        const int touching = run_counting(s, t.yardstick, 2500);
        const std::string with = "beta " + std::to_string(beta).substr(0, 3) + ": ";
        report.relative(with + "restitution", restitution(beta), s.frame().velocity[0].z, 2e-3, "exp(-pi z / sqrt(1 - z^2))");
        report.relative(with + "contact time, s", duration(beta, t.mass(0), 1e5), touching * dt, 2e-3, "pi / (w sqrt(1 - z^2))");
        compare(report, with + "after", s, t.yardstick, 1e-5, 1e-5);
    }
}

void bounce_of_pair(Report& report) {
    for (const double beta : {0.0, 0.1, 0.5}) {
        const double dt = 2e-5, zeta = beta * std::sqrt(2.0);  // c from the mean mass m, effective mass m / 2
        Trial t(dt, {1e5, 0, 0, beta, 0}, {});
        t.sphere({-0.1, 0, 0}, {1, 0, 0});
        t.sphere({0.1, 0, 0}, {-1, 0, 0});
        Simulation s = t.start(report);
        const int touching = run_counting(s, t.yardstick, 2500);
        const std::string with = "beta " + std::to_string(beta).substr(0, 3) + ": ";
        report.relative(with + "restitution", restitution(zeta), s.frame().velocity[1].x, 5e-3, "exp(-pi z / sqrt(1 - z^2)), z = sqrt(2) beta");
        report.relative(with + "contact time, s", duration(zeta, t.mass(0) / 2, 1e5), touching * dt, 2e-3, "pi / (w sqrt(1 - z^2))");
        compare(report, with + "after", s, t.yardstick, 1e-5, 1e-5);
    }
}

void hundred_bounces(Report& report) {
    const double dt = 2e-4, g = 10, start = 0.2;
    Trial t(dt, {}, {1e5, 0, 0, 0, 0}, {0, 0, -g});
    t.plane({}, {0, 0, 1});
    t.sphere({0, 0, start});
    Simulation s = t.start(report);
    Yardstick& y = t.yardstick;
    // In flight the scheme keeps v^2 / 2 + g z + g v dt / 2 exactly.
    const auto energy = [&](double z, double v) { return (v * v / 2 + g * (z - 0.1) + g * v * dt / 2) / (g * (start - 0.1)); };
    int bounces = 0;
    for (bool fell = false; bounces < 100;) {
        s.run(40);  // a contact lasts 144 steps: none is missed
        const double v = s.frame().velocity[0].z;
        bounces += fell && v > 0;
        fell = v < 0;
    }
    y.run(static_cast<int>(s.step_count()));
    while (s.statistics().contacts) s.step();
    while (y.contacts()) y.step();
    const Frame end = s.frame();
    const double left = energy(end.position[0].z, end.velocity[0].z);
    report.relative("energy after / before", 1, left, 5e-3, "conservation");
    report.relative("energy after / before", energy(y.spheres[0].x.z, y.spheres[0].v.z), left, 1e-3, "scheme in double");
}

void oblique_collision(Report& report) {
    Trial t(1e-4, {1e5, 3e4, 0.4, 0.15, 0.1}, {});
    t.sphere({-0.09, 0.02, 0}, {2, 0.5, -0.3}, {4, -10, 15});
    t.sphere({0.09, -0.02, 0.01}, {-1, 0.2, 0.4}, {-6, 8, 20}, 0.07);
    Simulation s = t.start(report);
    const Statistics before = s.statistics();
    const double speed = 2, m = t.mass(0);
    s.run(40);
    t.yardstick.run(40);
    compare(report, "while they touch", s, t.yardstick, 1e-6, 1e-6);
    s.run(360);
    t.yardstick.run(360);
    compare(report, "after", s, t.yardstick, 1e-5, 1e-5);
    const Statistics after = s.statistics();
    conserved(report, before, after, m * speed, m * speed * 0.1);
    report.absolute("share of the kinetic energy that is left is below 1", 0.5, kinetic(after) / kinetic(before), 0.5, "dissipation");
}

void unequal_pair(Report& report) {
    const double dt = 2e-6, beta = 0.01, small = 0.01, large = 0.1;
    Trial t(dt, {1e5, 3e4, 0, beta, 0}, {});
    t.sphere({-small, 0, 0}, {1, 0, 0}, {}, small);
    t.sphere({large, 0, 0}, {}, {}, large);
    Simulation s = t.start(report);
    const Statistics before = s.statistics();
    const int touching = run_counting(s, t.yardstick, 1000);
    const double a = t.mass(0), b = t.mass(1), reduced = a * b / (a + b), zeta = beta * std::sqrt((a + b) / 2 / reduced);
    const Frame f = s.frame();
    report.relative("radii 1:10: restitution", restitution(zeta), double{f.velocity[1].x} - double{f.velocity[0].x}, 5e-3, "z = beta sqrt(mean / reduced mass)");
    report.relative("radii 1:10: contact time, s", duration(zeta, reduced, 1e5), touching * dt, 5e-3, "pi / (w sqrt(1 - z^2))");
    compare(report, "radii 1:10: after", s, t.yardstick, 1e-5, 1e-5);
    report.absolute("radii 1:10: change of momentum / m v", 0, length(s.statistics().momentum - before.momentum) / a, 1e-5, "conservation");

    Trial o(dt, {1e5, 3e4, 0.4, beta, 0.01}, {});
    o.sphere({-small * 0.8, small * 0.55, 0}, {1, -0.5, 0.2}, {0, 40, -90}, small);
    o.sphere({large, 0, 0}, {}, {1, 2, 3}, large);
    Simulation u = o.start(report);
    u.run(1000);
    o.yardstick.run(1000);
    compare(report, "radii 1:10, oblique, friction: after", u, o.yardstick, 1e-4, 1e-5);
}

void heavy_sphere_as_wall(Report& report) {
    const Law law{1e5, 3e4, 0.4, 0, 0};  // no dashpot: it takes the mean mass, which for a wall is the sphere's own
    Trial wall(2e-5, law, law), heavy = wall;
    wall.plane({}, {0, 0, 1});
    for (Trial* t : {&wall, &heavy}) t->sphere({0, 0, 0.1}, {0, 0, -1});
    heavy.sphere({0, 0, -0.1}, {}, {}, 0.1, 2e12);
    Simulation a = wall.start(report), b = heavy.start(report);
    a.run(2500);
    b.run(2500);
    report.relative("head-on: speed after, m/s", a.frame().velocity[0].z, b.frame().velocity[0].z, 1e-5, "the same plane");
    report.absolute("head-on: height after, m", a.frame().position[0].z, b.frame().position[0].z, 1e-6, "the same plane");

    Trial spin = wall, top = wall;  // a spinning sphere: friction, without travel along the wall worth a curvature
    top.scene.planes.clear();
    top.yardstick.walls.clear();
    for (Trial* t : {&spin, &top}) {
        t->initial.angular_velocities[0] = {0, 2, 0};
        t->yardstick.spheres[0].w = {0, 2, 0};
    }
    top.sphere({0, 0, -10}, {}, {}, 10, 2e9);
    Simulation c = spin.start(report), d = top.start(report);
    c.run(2500);
    d.run(2500);
    report.relative("with spin, on a sphere of 10 m: sideways speed after, m/s", c.frame().velocity[0].x, d.frame().velocity[0].x, 1e-2, "the same plane");
    report.relative("with spin, on a sphere of 10 m: spin after, rad/s", c.frame().angular_velocity[0].y, d.frame().angular_velocity[0].y, 1e-2, "the same plane");
}

void materials(Report& report) {
    const Law soft{1e5, 2e4, 0.3, 0.1, 0}, hard{4e5, 1e5, 0.6, 0.3, 0};
    struct Rule {
        std::string name;
        Law pair, wall;
    };
    const Law series{1.6e5, 2 * 2e4 * 1e5 / 1.2e5, 0.3, 0.2, 0}, row{2e5, 2 * 2e4 * 1e5 / 1.2e5, 0.05, 0.2, 0};
    for (const Rule& rule : {Rule{"mixing series", series, series}, Rule{"mixing wall", series, hard}, Rule{"pair row (k_n, mu)", row, row}}) {
        Trial t(1e-4, soft, hard);  // the second sphere and the plane are of "wall"
        t.scene.contact.mixing = rule.name == "mixing wall" ? Mixing::wall : Mixing::series;
        if (rule.name.front() == 'p') t.scene.pairs.push_back({{"wall", "grain"}, 2e5, {}, 0.05, {}, {}});
        t.yardstick.pair = rule.pair;
        t.yardstick.wall = rule.wall;
        t.plane({}, {0, 0, 1});
        t.sphere({0, 0, 0.1}, {0.4, 0, -1});
        t.sphere({1, 0.02, 0.5}, {1, 0, 0});
        t.sphere({1.2, 0, 0.5}, {-1, 0, 0});
        t.initial.materials[2] = 1;
        Simulation s = t.start(report);
        s.run(300);
        t.yardstick.run(300);
        compare(report, rule.name, s, t.yardstick, 1e-5, 1e-5);
    }
}

}  // namespace grainray::validation
