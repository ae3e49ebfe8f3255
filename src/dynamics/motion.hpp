// Motion of one particle over one step, shared by every integrator. Symplectic Euler: v += a dt, x += v dt; x in fixed
// point, so a step is one rounding to a fine unit. v is a float with the remainder of its last rounding beside it, else
// g dt would lose the same bits at every step of a long fall.
#pragma once

#include "state.hpp"

namespace grainray {

struct Motion {
    StepConstants constants;
    float unit, force_quantum, torque_quantum, inverse_fine, trigger;

    Motion(const State& s, const StepConstants& c, float margin_trigger)
        : constants(c), unit(static_cast<float>(s.particles.scale.unit)), force_quantum(static_cast<float>(s.quanta.force)),
          torque_quantum(static_cast<float>(s.quanta.torque)), inverse_fine(static_cast<float>(1.0 / s.particles.scale.fine())),
          trigger(margin_trigger) {}

    /// Local damping (Cundall 1987), one axis: a <- a (1 - alpha sign(a v)).
    GR_HD float damped(float a, float v) const {
        const float power = a * v, sign = static_cast<float>((power > 0) - (power < 0));  // no branch: its side is a coin toss
        return a * (1.0f - constants.mass_damping * sign);
    }

    /// False where the step is not finite: then the position stays.
    GR_HD bool advance(const Wrench& w, Near& p, Far& f, Body& b, Vec3f& left) const {
        const float r = static_cast<float>(p.radius) * unit;
        const float inverse_mass = 1.0f / b.mass, inverse_inertia = 1.0f / (0.4f * b.mass * (r * r));
        const float dt = constants.dt;
        for (int a = 0; a < 3; ++a) {
            const float force = static_cast<float>(w.force[a]) * force_quantum;
            const float acceleration = force * inverse_mass + constants.gravity[a];
            const float before = b.velocity[a], change = damped(acceleration, before) * dt + left[a];
            b.velocity[a] = before + change;
            left[a] = change - (b.velocity[a] - before);
            b.spin[a] += static_cast<float>(w.torque[a]) * torque_quantum * inverse_inertia * dt;
        }
        constexpr float most = 1e15f;  // fine units; far beyond any sane step, and exact as an integer
        const Vec3f s = b.velocity * dt * inverse_fine;
        if (!(fabsf(s.x) < most && fabsf(s.y) < most && fabsf(s.z) < most)) return false;
        Vec3l x = join(p, f);
        x += Vec3l{llrintf(s.x), llrintf(s.y), llrintf(s.z)};
        p = {near_of(x.x), near_of(x.y), near_of(x.z), p.radius};
        f = far_of(x);
        return true;
    }

    /// Has the particle moved its margin, less what its surroundings moved in `age` steps since the list was built?
    GR_HD bool past_margin(const Near& p, const Near& built, const Vec3f& frame, float age) const {
        const Vec3f u = frame * age;
        const float dx = static_cast<float>(wrapped(p.x, built.x)) - u.x, dy = static_cast<float>(wrapped(p.y, built.y)) - u.y,
                    dz = static_cast<float>(wrapped(p.z, built.z)) - u.z;
        const float limit = static_cast<float>(built.radius) * trigger;
        return !(dx * dx + dy * dy + dz * dz < limit * limit);
    }
};

}  // namespace grainray
