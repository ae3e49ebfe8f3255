// Stage: motion. Symplectic Euler: v += a dt, x += v dt; x in fixed point, so a step is one rounding to a fine unit. v is a
// float with the remainder of its last rounding beside it, else g dt would lose the same bits at every step of a long fall.
#include "stages.hpp"

#include "exec/exec.hpp"

namespace grainray::GRAINRAY_EXEC {
namespace {

/// Local damping (Cundall 1987), one axis: a <- a (1 - alpha sign(a v)).
GR_HD inline float damped(float a, float v, float alpha) {
    const float power = a * v, sign = static_cast<float>((power > 0) - (power < 0));  // no branch: its side is a coin toss
    return a * (1.0f - alpha * sign);
}

struct Integrate {
    View<Near> near;
    View<Far> far;
    View<Body> body;
    View<Vec3f> remainder;
    View<Wrench> wrench;
    View<const Near> built;
    View<const Vec3f> frame;
    View<std::uint32_t> flags;
    StepConstants constants;
    float unit, force_quantum, torque_quantum, inverse_fine, trigger, age;  // age: steps since the list was built

    GR_HD void operator()(std::size_t i) const {
        Body& b = body[i];
        Wrench& w = wrench[i];
        Near p = near[i];
        const float r = static_cast<float>(p.radius) * unit;
        const float inverse_mass = 1.0f / b.mass, inverse_inertia = 1.0f / (0.4f * b.mass * (r * r));
        const float dt = constants.dt;
        Vec3f& left = remainder[i];
        for (int a = 0; a < 3; ++a) {
            const float force = static_cast<float>(w.force[a]) * force_quantum;
            const float acceleration = force * inverse_mass + constants.gravity[a];
            const float before = b.velocity[a], change = damped(acceleration, before, constants.mass_damping) * dt + left[a];
            b.velocity[a] = before + change;
            left[a] = change - (b.velocity[a] - before);
            b.spin[a] += static_cast<float>(w.torque[a]) * torque_quantum * inverse_inertia * dt;
            w.force[a] = w.torque[a] = 0;
        }
        move(i, p, b.velocity * dt);
    }

    GR_HD void move(std::size_t i, Near p, const Vec3f& step) const {
        constexpr float most = 1e15f;  // fine units; far beyond any sane step, and exact as an integer
        const Vec3f s = step * inverse_fine;
        if (!(fabsf(s.x) < most && fabsf(s.y) < most && fabsf(s.z) < most)) {
            atomic_min(&flags[1], static_cast<std::uint32_t>(i));
            return;
        }
        Vec3l x = join(p, far[i]);
        x += Vec3l{llrintf(s.x), llrintf(s.y), llrintf(s.z)};
        p = {near_of(x.x), near_of(x.y), near_of(x.z), p.radius};
        near[i] = p;
        far[i] = far_of(x);

        const Near b = built[i];
        const Vec3f u = frame[i] * age;
        const float dx = static_cast<float>(wrapped(p.x, b.x)) - u.x, dy = static_cast<float>(wrapped(p.y, b.y)) - u.y,
                    dz = static_cast<float>(wrapped(p.z, b.z)) - u.z;
        const float limit = static_cast<float>(b.radius) * trigger;
        if (!(dx * dx + dy * dy + dz * dz < limit * limit)) atomic_min(&flags[0], static_cast<std::uint32_t>(i));
    }
};

}  // namespace

void integrate(State& s, const StepConstants& constants, float trigger) {
    Particles& p = s.particles;
    for_each(s.size(), Integrate{p.near.view(), p.far.view(), p.body.view(), p.remainder.view(), s.wrench.view(), s.built.view(), s.frame.view(), s.flags.view(), constants,
                                 static_cast<float>(p.scale.unit), static_cast<float>(s.quanta.force), static_cast<float>(s.quanta.torque),
                                 static_cast<float>(1.0 / p.scale.fine()), trigger, static_cast<float>(s.age.steps)}, 1024);
}

}  // namespace grainray::GRAINRAY_EXEC
