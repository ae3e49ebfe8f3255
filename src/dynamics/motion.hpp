// Motion of one particle over one step, shared by every integrator. Symplectic Euler: v += a dt, x += v dt; x in fixed
// point, so a step is one rounding to a fine unit. v is a float with the remainder of its last rounding beside it, else
// g dt would lose the same bits at every step of a long fall.
#pragma once

#include <bit>

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

    /// Velocities after the step under a force and a torque, in quanta. `radius` in units.
    GR_HD void kick(const Vec3f& force, const Vec3f& torque, float mass, std::int32_t radius, Vec3f& velocity, Vec3f& spin, Vec3f& left) const {
        const float r = static_cast<float>(radius) * unit;
        const float inverse_mass = 1.0f / mass, inverse_inertia = 1.0f / (0.4f * mass * (r * r));
        const float dt = constants.dt;
        for (int a = 0; a < 3; ++a) {
            const float acceleration = force[a] * force_quantum * inverse_mass + constants.gravity[a];
            const float before = velocity[a], change = damped(acceleration, before) * dt + left[a];
            velocity[a] = before + change;
            left[a] = change - (velocity[a] - before);
            spin[a] += torque[a] * torque_quantum * inverse_inertia * dt;
        }
    }

    /// The way of one step, fine units.
    GR_HD Vec3f way(const Vec3f& velocity) const { return velocity * constants.dt * inverse_fine; }
    /// Far beyond any sane step, and exact as an integer.
    GR_HD static bool sane(const Vec3f& way) {
        constexpr float most = 1e15f;
        return (fabsf(way.x) < most) & (fabsf(way.y) < most) & (fabsf(way.z) < most);
    }

    /// llrintf() where |v| < 2^51, in a form that vectorises.
    GR_HD static std::int64_t rounded(float v) {
        return std::bit_cast<std::int64_t>(static_cast<double>(v) + quantum_magic) - std::bit_cast<std::int64_t>(quantum_magic);
    }

    /// False where the step is not finite: then the position stays.
    GR_HD bool advance(const Wrench& w, Near& p, Far& f, Body& b, Vec3f& left) const {
        kick(float_of(w.force), float_of(w.torque), b.mass, p.radius, b.velocity, b.spin, left);
        const Vec3f s = way(b.velocity);
        if (!sane(s)) return false;
        Vec3l x = join(p, f);
        x += Vec3l{llrintf(s.x), llrintf(s.y), llrintf(s.z)};
        p = {near_of(x.x), near_of(x.y), near_of(x.z), p.radius};
        f = far_of(x);
        return true;
    }
    GR_HD static Vec3f float_of(const std::int64_t (&v)[3]) { return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])}; }

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
