// Linear spring and dashpot with Coulomb friction (Cundall & Strack 1979), tangential history as elastic force.
//   f_n = k_n u - c_n v_n          c = 2 beta sqrt(m k), m the mean mass
//   f_t = f_t' - k_t v_t dt - c_t v_t, |f_t| <= mu |f_n| by scaling; f_t' is turned into the current tangent plane first
// Uses + - * / sqrt alone and no branches: it vectorises, and IEEE 754 fixes every bit on CPU and GPU.
#pragma once

#include "grainray/contacts.hpp"

namespace grainray {

struct LinearLaw {
    float dt;

    /// Force on i, N. history: elastic tangential force on i, kept while the pair touches (0 at first touch).
    GR_HD Vec3f operator()(const Contact& c, const PairParameters& p, Vec3f& history) const {
        const float root_mass = sqrtf(c.mean_mass);
        const float vn = dot(c.velocity, c.normal);
        const float fn = p.kn * c.overlap - p.cn * root_mass * vn;
        const Vec3f vt = c.velocity - c.normal * vn;

        const Vec3f tangent = history - c.normal * dot(history, c.normal);
        const float before = dot(history, history), after = dot(tangent, tangent);
        const float turn = after > 0 ? sqrtf(before / (after > 0 ? after : 1.0f)) : 0.0f;
        const Vec3f viscous = vt * (p.ct * root_mass);
        const Vec3f trial = tangent * turn - vt * (p.kt * dt) - viscous;

        const float size = sqrtf(dot(trial, trial)), cap = p.mu * fabsf(fn);
        const float scale = size > cap ? cap / (size > 0 ? size : 1.0f) : 1.0f;
        const Vec3f ft = trial * scale;
        history = ft + viscous;
        return c.normal * fn + ft;
    }
};

}  // namespace grainray
