// One pair of spheres: do they touch, and what does a law make of it. Shared by every pair loop on every device.
#pragma once

#include "contacts/wrench.hpp"
#include "grainray/contacts.hpp"
#include "grainray/particles.hpp"

namespace grainray {

/// x_i - x_j in units, and R^2 - d^2 as an exact integer: the spheres touch when it is positive.
struct Separation {
    std::int32_t x, y, z;
    std::int64_t gap;
};

GR_HD inline Separation separation(std::int32_t x, std::int32_t y, std::int32_t z, std::int64_t radii) {
    // Unsigned: where spheres have flown apart within a step, which a look at the state may meet, nothing is undefined.
    const auto square = [](std::int64_t v) { return static_cast<std::uint64_t>(v * v); };
    return {x, y, z, static_cast<std::int64_t>(square(radii) - (square(x) + square(y) + square(z)))};
}
/// Unsigned subtraction wraps, which is what makes the near words enough.
GR_HD inline std::int32_t wrapped(std::int32_t a, std::int32_t b) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}
GR_HD inline Separation separation(const Near& a, const Near& b) {
    return separation(wrapped(a.x, b.x), wrapped(a.y, b.y), wrapped(a.z, b.z), std::int64_t{a.radius} + b.radius);
}
/// Periodic axes: whole positions, nearest image. period in units, 0 where an axis is not periodic.
GR_HD inline std::int32_t image(std::int64_t d, std::int64_t period) {
    if (period > 0 && 2 * d > period) d -= period;
    if (period > 0 && 2 * d < -period) d += period;
    constexpr std::int64_t far_away = std::int64_t{1} << 30;  // listed pairs are nearer; held so that squares fit
    return static_cast<std::int32_t>(d > far_away ? far_away : d < -far_away ? -far_away : d);
}
GR_HD inline Separation separation(const Near& a, const Far& fa, const Near& b, const Far& fb, const Vec3l& period) {
    const Vec3l p = join(a, fa), q = join(b, fb);
    return separation(image((p.x >> fine_bits) - (q.x >> fine_bits), period.x), image((p.y >> fine_bits) - (q.y >> fine_bits), period.y),
                      image((p.z >> fine_bits) - (q.z >> fine_bits), period.z), std::int64_t{a.radius} + b.radius);
}

/// What a contact does: force on i (j gets its negative) and the torques on both.
struct PairForce {
    Vec3f force, torque_i, torque_j;
};

/// Geometry, relative motion at the contact point (lever arms r - u/2), law. x, y, z, radii in units, square_distance d^2
/// and gap R^2 - d^2 rounded once from the exact integers.
template <class Law>
GR_HD inline PairForce pair_force(const Law& law, std::int32_t x, std::int32_t y, std::int32_t z, float square_distance, float gap,
                                  std::int32_t radius_i, std::int32_t radius_j, const Vec3f& velocity, const Vec3f& spin_i, const Vec3f& spin_j,
                                  float mean_mass, const PairParameters& parameters, float unit, Vec3f& history) {
    const float ri = static_cast<float>(radius_i), rj = static_cast<float>(radius_j), radii = static_cast<float>(radius_i + radius_j);
    const float d = sqrtf(square_distance);
    // u = R - d without cancellation; coincident centres have no direction and feel no force.
    const float overlap = gap / (radii + d) * unit;
    const float inverse = d > 0 ? 1.0f / d : 0.0f;
    const Vec3f n{static_cast<float>(x) * inverse, static_cast<float>(y) * inverse, static_cast<float>(z) * inverse};
    const float arm_i = ri * unit - 0.5f * overlap, arm_j = rj * unit - 0.5f * overlap;

    const Vec3f at_contact = velocity - cross(spin_i * arm_i + spin_j * arm_j, n);
    const Vec3f force = law(Contact{n, overlap, at_contact, mean_mass}, parameters, history);
    const Vec3f moment = cross(n, force);
    return {force, moment * -arm_i, moment * -arm_j};
}
template <class Law>
GR_HD inline PairForce pair_force(const Law& law, const Separation& s, std::int32_t radius_i, std::int32_t radius_j, const Vec3f& velocity,
                                  const Vec3f& spin_i, const Vec3f& spin_j, float mean_mass, const PairParameters& parameters, float unit,
                                  Vec3f& history) {
    const std::int64_t sum = static_cast<std::int64_t>(radius_i) + radius_j;
    return pair_force(law, s.x, s.y, s.z, static_cast<float>(sum * sum - s.gap), static_cast<float>(s.gap), radius_i, radius_j, velocity,
                      spin_i, spin_j, mean_mass, parameters, unit, history);
}

/// Everything the pair loop reads and writes; views, copied to the device.
struct PairLoop {
    View<const Near> near;
    View<const Far> far;
    View<const Body> body;
    View<const std::uint64_t> offsets;
    View<const std::uint32_t> partners;
    View<Vec3f> history;                  ///< one an entry of partners
    View<const PairParameters> parameters;
    std::uint32_t materials;
    std::uint32_t block;                  ///< the list is ListKind::blocked with this block
    float unit;
    double inverse_force, inverse_torque; ///< 1 / quanta
    Vec3l period;
    View<Wrench> wrench;
    View<std::uint8_t> touched;           ///< of the CPU: 1 where a history may be other than zero

    GR_HD const PairParameters& of(std::uint32_t a, std::uint32_t b) const { return parameters[a * materials + b]; }
    bool periodic() const { return period.x > 0 || period.y > 0 || period.z > 0; }
};

}  // namespace grainray
