// Motion: gravity, damping, the periodic box, the place in the world; and a heap, where everything meets.
#include <bit>

#include "validation/cases.hpp"

namespace grainray::validation {
namespace {

constexpr double g = 10;

/// 32-bit words of velocity and spin that differ between two simulations.
int different_words(const Simulation& a, const Simulation& b) {
    const Frame p = a.frame(), q = b.frame();
    int count = 0;
    for (std::size_t i = 0; i < p.size(); ++i)
        for (int k = 0; k < 3; ++k) {
            count += std::bit_cast<std::uint32_t>(p.velocity[i][k]) != std::bit_cast<std::uint32_t>(q.velocity[i][k]);
            count += std::bit_cast<std::uint32_t>(p.angular_velocity[i][k]) != std::bit_cast<std::uint32_t>(q.angular_velocity[i][k]);
        }
    return count;
}

double worst_shift_error(const Simulation& a, const Simulation& b, const Vec3d& shift) {
    const Frame p = a.frame(), q = b.frame();
    double worst = 0;
    for (std::size_t i = 0; i < p.size(); ++i) worst = std::max(worst, length(q.position[i] - p.position[i] - shift));
    return worst;
}

/// 27 spheres in a loose heap above the corner of a floor and two walls. With the columns' dt of 1e-3 s and walls of 1e7 N/m
/// a difference of 1e-9 m grows 1e5-fold in 0.1 s (in double precision too): a comparison needs softer walls, shorter steps.
Trial corner_heap() {
    Trial t(2e-4, {1e5, 1e5, 0.5, 0.5, 0}, {2e5, 4e5 / 7, 1.0, 0.5, 0}, {0, 0, -g}, 0.1);
    t.plane({}, {0, 0, 1});
    t.plane({}, {1, 0, 0});
    t.plane({}, {0, 1, 0});
    for (int k = 0; k < 27; ++k) {  // offsets are multiples of 1/64 m: exact in any number format here
        const double i = k % 3, j = k / 3 % 3, h = k / 9, dx = (5 * k % 7) / 512.0, dy = (3 * k % 5) / 512.0;
        t.sphere({0.125 + 0.21875 * i + dx, 0.125 + 0.21875 * j + dy, 0.125 + 0.21875 * h});
    }
    return t;
}

}  // namespace

void free_fall(Report& report) {
    const std::string scheme = "z0 + v0 n dt - g dt^2 n (n + 1) / 2";
    for (const int steps : {1, 10, 100, 1000, 10000}) {
        Trial t(1e-3, {}, {}, {0, 0, -g});
        t.sphere({0, 0, 0}, {3, 0, 1});
        Simulation s = t.start(report);
        s.run(static_cast<std::uint64_t>(steps));
        const double n = steps, dt = 1e-3;
        report.relative("fall after " + std::to_string(steps) + " steps, m", n * dt - g * dt * dt * n * (n + 1) / 2,
                        s.frame().position[0].z, 1e-6, scheme);
        if (steps == 10000) report.relative("drift along x after 10000 steps, m", 3 * n * dt, s.frame().position[0].x, 2e-6, "v t");
    }
    // The smaller g dt is beside v, the more of it a bare float would lose at every step.
    for (const int steps : {100000, 1000000}) {
        const double dt = 1.0 / steps, expected = -g / 2 * (1 + dt);
        Trial t(dt, {}, {}, {0, 0, -g});
        t.sphere({});
        Simulation s = t.start(report);
        s.run(static_cast<std::uint64_t>(steps));
        report.relative("fall after 1 s in " + std::to_string(steps) + " steps, m", expected, s.frame().position[0].z, 1e-6, scheme);
    }
}

void mass_damping(Report& report) {
    const double alpha = 0.3, dt = 1e-4;
    Trial t(dt, {}, {}, {2, -1, -g}, alpha);
    t.sphere({}, {-1, 0.5, 5});
    Simulation s = t.start(report);
    const int steps = 8000;
    s.run(steps);
    t.yardstick.run(steps);
    const Vec3f v = s.frame().velocity[0];
    for (int a = 0; a < 3; ++a) {
        const double pull = std::fabs(t.scene.gravity[a]), v0 = std::fabs(t.initial.velocities[0][a]), turn = v0 / (pull * (1 + alpha));
        report.relative(std::string("thrown against gravity: speed at 0.8 s along ") + "xyz"[a] + ", m/s", pull * (1 - alpha) * (steps * dt - turn),
                        std::fabs(v[a]), 1e-3, "g (1 - a)(t - v0 / (g (1 + a)))");
    }
    compare(report, "thrown, 0.8 s", s, t.yardstick, 3e-4, 1e-5);

    // A sphere that bobs on the floor about its rest: each half swing is sqrt((1 - a) / (1 + a)) of the one before.
    Trial b(dt, {}, {1e4, 0, 0, 0, 0}, {0, 0, -g}, alpha);
    b.plane({}, {0, 0, 1});
    const double rest = b.scene.gravity.z * -2000 * 4 / 3 * pi * 1e-3 / 1e4, half = pi / 2 * std::sqrt(8 * pi / 3 / 1e4) * (1 / std::sqrt(1 - alpha) + 1 / std::sqrt(1 + alpha));
    b.sphere({0, 0, 0.1 - 1.5 * rest});
    Simulation bob = b.start(report);
    const int swings = 2, count = static_cast<int>(std::lround(swings * half / dt)), later = count / 8;
    bob.run(static_cast<std::uint64_t>(count));
    report.relative("bobbing on the floor: second swing, m", 0.5 * rest * std::pow((1 - alpha) / (1 + alpha), 0.5 * swings),
                    0.1 - rest - bob.frame().position[0].z, 5e-3, "u0 (1 - a) / (1 + a)");
    bob.run(static_cast<std::uint64_t>(later));
    b.yardstick.run(count + later);
    compare(report, "bobbing", bob, b.yardstick, 1e-6, 1e-4);
    bob.run(80000);
    report.relative("bobbing: overlap at rest, m", rest, 0.1 - bob.frame().position[0].z, 1e-5, "m g / k");
}

void heap(Report& report) {
    Trial t = corner_heap();
    Simulation s = t.start(report);
    for (const int until : {500, 1000, 1500}) {
        while (s.step_count() < static_cast<std::uint64_t>(until)) {
            s.step();
            t.yardstick.step();
        }
        compare(report, "27 spheres, " + std::to_string(until) + " steps", s, t.yardstick, 1e-5, 1e-4);
    }
    report.absolute("touching pairs and walls", t.yardstick.contacts(), static_cast<double>(s.statistics().contacts), 0, "scheme in double");
}

void periodic_crossing(Report& report) {
    const auto collide = [&](double shift) {
        Trial t(1e-3, {1e5, 5e4, 0.5, 0.2, 0.1}, {});
        t.scene.domain.box = Box{{0, 0, 0}, {8, 8, 8}};
        t.scene.domain.periodic = {true, true, true};
        const auto wrap = [&](Vec3d x) {
            for (int a = 0; a < 3; ++a) x[a] = std::fmod(x[a] + shift, 8);
            return x;
        };
        t.sphere(wrap({3.875, 4, 4}), {1, 0.25, -0.125}, {0, 3, 5});
        t.sphere(wrap({4.125, 4.0625, 3.96875}), {-1, 0, 0.125}, {1, 0, -4}, 0.078125);
        Simulation s = t.start(report);
        s.run(200);
        return s;
    };
    const Simulation inside = collide(0), across = collide(4);
    report.absolute("200 steps across the corner of the box: words of v and w that differ from inside", 0, different_words(inside, across), 0,
                    "the same pair inside");
    const Frame a = inside.frame(), b = across.frame();
    double worst = 0;
    for (std::size_t i = 0; i < 2; ++i)
        for (int k = 0; k < 3; ++k) worst = std::max(worst, std::fabs(std::remainder(b.position[i][k] - a.position[i][k] - 4, 8)));
    report.absolute("the same: largest difference of a coordinate, m", 0, worst, 0, "the same pair inside");
    report.absolute("the same: they did collide, change of v.x, m/s", 2, 1 - static_cast<double>(a.velocity[0].x), 1.5, "bounce");
}

void shifted_world(Report& report) {
    const Vec3d shift{1e4, 2e5, 3e3};
    Trial here = corner_heap(), there = here;
    for (Vec3d& x : there.initial.positions) x += shift;
    for (Plane& p : there.scene.planes) p.point += shift;
    Simulation a = here.start(report), b = there.start(report);
    for (const int steps : {500, 4500}) {
        a.run(static_cast<std::uint64_t>(steps));
        b.run(static_cast<std::uint64_t>(steps));
    }
    report.absolute("heap moved by (1e4, 2e5, 3e3) m, 5000 steps: words of v and w that differ", 0, different_words(a, b), 0, "the heap at the origin");
    report.absolute("the same: largest difference of a position, m", 0, worst_shift_error(a, b, shift), 1e-10, "the heap at the origin");
}

}  // namespace grainray::validation
