// Small helpers that every part of the picture shares. Colours are Vec3f: linear light until the canvas, then display.
#pragma once

#include <algorithm>
#include <cstdint>

#include "grainray/core.hpp"

namespace grainray::picture {

using Color = Vec3f;

template <class T>
Vec3<T> normalized(const Vec3<T>& a) { return a * (T(1) / length(a)); }

template <class V>
V mix(const V& a, const V& b, float t) { return a * (1 - t) + b * t; }

inline Color times(const Color& a, const Color& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

/// 0 below 0, 1 above 1, a smooth step between.
inline float smooth_step(float t) {
    t = std::clamp(t, 0.f, 1.f);
    return t * t * (3 - 2 * t);
}

inline float display_from_linear(float v) {
    v = std::clamp(v, 0.f, 1.f);
    return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
}

inline float linear_from_display(float v) {
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

inline Color linear_from_display(const Color& c) {
    return {linear_from_display(c.x), linear_from_display(c.y), linear_from_display(c.z)};
}

inline Color display_from_linear(const Color& c) {
    return {display_from_linear(c.x), display_from_linear(c.y), display_from_linear(c.z)};
}

/// Mixes the bits of a number: noise that is the same on every run and every thread.
inline std::uint32_t hash(std::uint32_t v) {
    v = (v ^ (v >> 16)) * 0x7feb352du;
    v = (v ^ (v >> 15)) * 0x846ca68bu;
    return v ^ (v >> 16);
}

/// A hash as a number in [0, 1).
inline float unit_from_bits(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

}  // namespace grainray::picture
