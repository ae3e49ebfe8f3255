#include "validation/yardstick.hpp"

namespace grainray::validation {
namespace {

/// v turned about a unit axis: the part along it stays, the rest turns in its plane.
Vec3d turned(const Vec3d& v, const Vec3d& axis, double angle) {
    const Vec3d along = axis * dot(v, axis), across = v - along;
    return along + across * std::cos(angle) + cross(axis, across) * std::sin(angle);
}

double damping(double beta, double mass, double stiffness) { return 2 * beta * std::sqrt(mass * stiffness); }

}  // namespace

void Yardstick::push(int i, const Vec3d& f, const Vec3d& torque) {
    force_[static_cast<std::size_t>(i)] += f;
    torque_[static_cast<std::size_t>(i)] += torque;
}

/// The linear law: spring and dashpot along n; across it a spring that remembers, a dashpot, and Coulomb's cap on both.
Vec3d Yardstick::force(const Law& law, const Touch& t, const Key& key) {
    const double approach = dot(t.v, t.n), normal = law.kn * t.u - damping(law.bn, t.mean_mass, law.kn) * approach;
    const Vec3d slip = t.v - t.n * approach, viscous = slip * damping(law.bt, t.mean_mass, law.kt);

    Vec3d& memory = elastic_[key];
    Vec3d spring = memory - t.n * dot(memory, t.n);
    if (const double flat = length(spring); flat > 0) spring *= length(memory) / flat;
    Vec3d friction = spring - slip * (law.kt * dt) - viscous;
    const double most = law.mu * std::fabs(normal), size = length(friction);
    if (size > most) friction *= most / size;
    memory = friction + viscous;
    return t.n * normal + friction;
}

void Yardstick::touch_pair(int i, int j) {
    const Sphere &a = spheres[static_cast<std::size_t>(i)], &b = spheres[static_cast<std::size_t>(j)];
    const Vec3d to_i = a.x - b.x;
    const double distance = length(to_i), u = a.r + b.r - distance;
    if (!(u > 0)) {
        elastic_.erase({i, j});
        return;
    }
    const Vec3d n = to_i * (1 / distance), arm_i = n * -(a.r - u / 2), arm_j = n * (b.r - u / 2);
    const Vec3d v = a.v + cross(a.w, arm_i) - b.v - cross(b.w, arm_j);
    const Vec3d f = force(pair, {n, u, v, (a.m + b.m) / 2}, {i, j});
    push(i, f, cross(arm_i, f));
    push(j, -f, cross(arm_j, -f));
}

void Yardstick::touch_wall(int i, int q) {
    const Sphere& s = spheres[static_cast<std::size_t>(i)];
    const Wall& w = walls[static_cast<std::size_t>(q)];
    const Vec3d centre = w.centre + w.velocity * time, n = turned(w.normal, w.axis, w.rate * time);
    const Vec3d point = centre + turned(w.point - w.centre, w.axis, w.rate * time);
    const double u = s.r - dot(s.x - point, n);
    if (!(u > 0)) {
        elastic_.erase({i, -1 - q});
        return;
    }
    const Vec3d arm = n * -(s.r - u / 2), wall_velocity = w.velocity + cross(w.axis * w.rate, s.x + arm - centre);
    const Vec3d f = force(wall, {n, u, s.v + cross(s.w, arm) - wall_velocity, s.m}, {i, -1 - q});
    push(i, f, cross(arm, f));
}

void Yardstick::step() {
    const int n = static_cast<int>(spheres.size());
    force_.assign(spheres.size(), {});
    torque_.assign(spheres.size(), {});
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < i; ++j) touch_pair(i, j);
        for (int q = 0; q < static_cast<int>(walls.size()); ++q) touch_wall(i, q);
    }
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        Sphere& s = spheres[i];
        const Vec3d a = force_[i] * (1 / s.m) + gravity;
        for (int k = 0; k < 3; ++k) {
            const double power = a[k] * s.v[k];
            s.v[k] += a[k] * (power > 0 ? 1 - alpha : power < 0 ? 1 + alpha : 1) * dt;
        }
        s.w += torque_[i] * (dt / (0.4 * s.m * s.r * s.r));
        s.x += s.v * dt;
    }
    time += dt;
}

}  // namespace grainray::validation
