// Spheres on planes: rolling, sliding, resting, carried. The contact point is r - u / 2 from the centre, which makes
// q = (r / (r - u / 2))^2 appear where textbooks have 1.
#include "validation/cases.hpp"

namespace grainray::validation {
namespace {

constexpr double g = 10, r = 0.1, m = 2000 * 4.0 / 3.0 * pi * r * r * r;

/// 2/5 q: I / (m arm^2) for overlap u.
double inertia_ratio(double u) { return 0.4 * (r / (r - u / 2)) * (r / (r - u / 2)); }

void run(Simulation& s, Yardstick& y, int steps) {
    s.run(static_cast<std::uint64_t>(steps));
    y.run(steps);
}

/// Acceleration down an incline of slope tan(theta), measured over 0.5 s once the tangential spring has settled.
double acceleration(Report& report, double slope, const Law& law) {
    const double theta = std::atan(slope), u = m * g * std::cos(theta) / law.kn, dt = 1e-4;
    const Vec3d normal{std::sin(theta), 0, std::cos(theta)}, down{std::cos(theta), 0, -std::sin(theta)};
    Trial t(dt, law, law, {0, 0, -g});
    t.plane({}, normal);
    t.sphere(normal * (r - u));
    Simulation s = t.start(report);
    run(s, t.yardstick, 5000);
    const double first = dot(convert<double>(s.frame().velocity[0]), down);
    run(s, t.yardstick, 5000);
    const double second = dot(convert<double>(s.frame().velocity[0]), down);
    compare(report, "tan " + std::to_string(slope).substr(0, 6) + ", 1 s", s, t.yardstick, 1e-3, 1e-4);
    return (second - first) / (5000 * dt);
}

}  // namespace

void sliding_to_rolling(Report& report) {
    const Law law{1e6, 3e5, 0.3, 0.3, 0.2};
    const double v0 = 2, u = m * g / law.kn, k = inertia_ratio(u), dt = 1e-4;
    Trial t(dt, law, law, {0, 0, -g});
    t.plane({}, {0, 0, 1});
    t.sphere({0, 0, r - u}, {v0, 0, 0});
    Simulation s = t.start(report);
    run(s, t.yardstick, 1000);
    report.relative("speed after 0.1 s of sliding, m/s", v0 - law.mu * g * 0.1, s.frame().velocity[0].x, 1e-4, "v0 - mu g t");
    report.relative("spin after 0.1 s of sliding, rad/s", law.mu * g * 0.1 * (r - u / 2) / (0.4 * r * r), s.frame().angular_velocity[0].y, 1e-4,
                    "mu m g (r - u/2) t / I");
    run(s, t.yardstick, 9000);
    report.relative("speed of rolling / v0", 1 / (1 + k), double{s.frame().velocity[0].x} / v0, 1e-4, "5/7, with the arm r - u/2");
    report.shown("the same beside the textbook", 5.0 / 7, double{s.frame().velocity[0].x} / v0, "5/7");
    report.relative("spin times arm / speed", 1, double{s.frame().angular_velocity[0].y} * (r - u / 2) / double{s.frame().velocity[0].x}, 1e-4, "no slip");
    compare(report, "1 s", s, t.yardstick, 1e-3, 1e-4);
}

void inclines(Report& report) {
    const Law law{1e6, 3e5, 0.2, 0.3, 0.3};
    const double k = inertia_ratio(m * g / law.kn), limit = law.mu * (1 + k) / k;  // 7/2 mu
    for (const double share : {0.5, 0.98, 1.02, 1.3}) {
        const double slope = limit * share, theta = std::atan(slope);
        const bool rolls = share < 1;
        report.relative((rolls ? "rolls at " : "slides at ") + std::to_string(share).substr(0, 4) + " of the limit: acceleration, m/s2",
                        rolls ? g * std::sin(theta) / (1 + k) : g * (std::sin(theta) - law.mu * std::cos(theta)), acceleration(report, slope, law), 5e-4,
                        rolls ? "5/7 g sin, limit tan = 7/2 mu" : "g (sin - mu cos)");
    }
}

void stack(Report& report) {
    const Law law{1e5, 1e5, 0.5, 0.5, 0};
    Trial t(1e-3, law, {1e6, 1e6, 1, 0.5, 0}, {0, 0, -g}, 0.1);
    t.plane({}, {0, 0, 1});
    for (int k = 0; k < 10; ++k) t.sphere({0, 0, (2 * k + 1) * r});
    Simulation s = t.start(report);
    s.run(20000);
    const Frame f = s.frame();
    double worst = 0;
    for (std::size_t k = 0; k + 1 < f.size(); ++k) {
        const double weight = (9.0 - static_cast<double>(k)) * m * g, overlap = 2 * r - (f.position[k + 1].z - f.position[k].z);
        worst = std::max(worst, std::fabs(overlap * law.kn / weight - 1));
    }
    report.absolute("worst of 9 overlaps against weight above / k, share", 0, worst, 1e-5, "statics");
    report.relative("overlap with the floor, m", 10 * m * g / 1e6, r - f.position[0].z, 1e-5, "10 m g / k_wall");
    report.absolute("fastest after 20 s, m/s", 0, s.statistics().max_speed, 1e-6, "rest");
}

void piston(Report& report) {
    const double v = 0.5, k = 1e5, dt = 1e-4;
    Trial t(dt, {}, {k, 1e5, 0.5, 0.3, 0}, {0, 0, -g});
    Motion motion;
    motion.velocity = {0, 0, v};
    t.plane({}, {0, 0, 1}, motion);
    t.sphere({0, 0, r});
    Simulation s = t.start(report);
    run(s, t.yardstick, 500);
    compare(report, "0.05 s", s, t.yardstick, 1e-5, 1e-5);
    run(s, t.yardstick, 19500);
    report.relative("speed after 2 s, m/s", v, s.frame().velocity[0].z, 1e-5, "the piston's");
    report.absolute("height above the piston, m", r - m * g / k, s.frame().position[0].z - v * 2, 1e-6, "r - m g / k");
}

/// A sphere that rolls on a turning table goes in a circle, at 2/7 of the table's rate for a point contact.
void turntable(Report& report) {
    const Law law{1e6, 3e5, 0.5, 0.3, 0.2};
    const double rate = 7, dt = 1e-4, u = m * g / law.kn, k = inertia_ratio(u), orbit = rate * k / (1 + k), speed = 0.5, arm = r - u / 2;
    Motion motion;
    motion.rotation_axis = {0, 0, 1};
    motion.rotation_rate = rate;
    Trial t(dt, law, law, {0, 0, -g}), drag = t;
    for (Trial* table : {&t, &drag}) table->plane({}, {0, 0, 1}, motion);
    const Vec3d x{1, 0, r - u}, v{0, speed, 0};
    // No slip: v + w x (-arm n) = rate n x x
    const Vec3d slip = v - cross(Vec3d{0, 0, rate}, x), w = cross(Vec3d{0, 0, 1}, slip) * (1 / arm);
    t.sphere(x, v, w);
    Simulation s = t.start(report);
    const int quarter = static_cast<int>(std::lround(pi / 2 / orbit / dt));
    const Vec3d centre{1 - speed / orbit, 0, r - u};
    run(s, t.yardstick, 2 * quarter);
    report.relative("diameter of the circle, m", 2 * speed / orbit, length(s.frame().position[0] - x), 5e-3, "2 v / (2/7 rate)");
    run(s, t.yardstick, 2 * quarter);
    report.absolute("distance from the start after one round / radius", 0, length(s.frame().position[0] - x) * orbit / speed, 2e-2, "2/7 of the table's rate");
    report.relative("distance from the circle's centre, m", speed / orbit, length(s.frame().position[0] - centre), 1e-2, "v / (2/7 rate)");
    compare(report, "one round", s, t.yardstick, 1e-2, 1e-3);

    drag.sphere(x);
    Simulation d = drag.start(report);
    run(d, drag.yardstick, 500);
    report.relative("at rest on it: speed after 0.05 s, m/s", law.mu * g * 0.05, length(convert<double>(d.frame().velocity[0])), 1e-3, "mu g t");
    compare(report, "at rest on it, 0.05 s", d, drag.yardstick, 1e-5, 1e-5);
}

/// A plane that tilts about an axis in itself lifts a sphere and lets it roll.
void paddle(Report& report) {
    const Law law{1e5, 3e4, 0.5, 0.3, 0.1};
    Motion motion;
    motion.rotation_axis = {0, -1, 0};
    motion.rotation_point = {0.25, 0, 0};
    motion.rotation_rate = 0.8;
    Trial t(1e-4, law, law, {0, 0, -g});
    t.plane({}, {0, 0, 1}, motion);
    t.sphere({1, 0.125, r - m * g / law.kn});
    Simulation s = t.start(report);
    run(s, t.yardstick, 5000);
    compare(report, "0.5 s", s, t.yardstick, 1e-3, 1e-4);
    const double angle = 0.8 * 0.5;
    const Vec3d n{-std::sin(angle), 0, std::cos(angle)}, x = s.frame().position[0] - Vec3d{0.25, 0, 0};
    report.absolute("distance from the plane, turned by 0.4 rad, m", r - m * g * std::cos(angle) / law.kn, dot(x, n), 1e-3, "r - m g cos / k");
}

}  // namespace grainray::validation
