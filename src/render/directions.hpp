// Where rays of light are sent: even noise, directions about a normal.
#pragma once

#include <cmath>
#include <numbers>

#include "render/math.hpp"

namespace grainray::picture {

/// Two numbers in [0, 1), evenly spread over successive k (the R2 sequence), shifted by the pixel's own hash.
struct Pair { float u, v; };
class Noise {
public:
    explicit Noise(std::uint32_t seed) : u_(hash(seed)), v_(hash(seed ^ 0x9e3779b9u)) {}
    Pair operator()(std::uint32_t k) const { return {unit_from_bits(u_ + k * 3242174889u), unit_from_bits(v_ + k * 2447445414u)}; }

private:
    std::uint32_t u_, v_;
};

/// Two unit vectors that are perpendicular to n and to each other.
struct Tangents {
    Vec3f a, b;
    explicit Tangents(const Vec3f& n) : a(normalized(cross(n, std::abs(n.x) < 0.6f ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0}))), b(cross(n, a)) {}
};

/// Within the hemisphere about n, as often as a matte surface looks there.
inline Vec3f matte_direction(const Vec3f& n, const Pair& p) {
    const Tangents t(n);
    const float angle = 2 * std::numbers::pi_v<float> * p.u, radius = std::sqrt(p.v);
    return t.a * (radius * std::cos(angle)) + t.b * (radius * std::sin(angle)) + n * std::sqrt(1 - p.v);
}

}  // namespace grainray::picture
