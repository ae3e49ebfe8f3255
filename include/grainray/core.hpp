// The vocabulary of every other header: real numbers, vectors, boxes, errors. Compiles with and without CUDA.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#if defined(__CUDACC__)
#define GR_HD __host__ __device__
#else
#define GR_HD
#endif

namespace grainray {

/// Forces, velocities and histories are single precision; positions are 64-bit fixed point (particles.hpp).
using Real = float;

template <class T>
struct Vec3 {
    T x{}, y{}, z{};

    GR_HD constexpr T& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
    GR_HD constexpr const T& operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
    GR_HD constexpr Vec3& operator+=(const Vec3& b) { x += b.x; y += b.y; z += b.z; return *this; }
    GR_HD constexpr Vec3& operator-=(const Vec3& b) { x -= b.x; y -= b.y; z -= b.z; return *this; }
    GR_HD constexpr Vec3& operator*=(T s) { x *= s; y *= s; z *= s; return *this; }
    GR_HD friend constexpr Vec3 operator+(Vec3 a, const Vec3& b) { return a += b; }
    GR_HD friend constexpr Vec3 operator-(Vec3 a, const Vec3& b) { return a -= b; }
    GR_HD friend constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
    GR_HD friend constexpr Vec3 operator*(Vec3 a, T s) { return a *= s; }
    GR_HD friend constexpr Vec3 operator*(T s, Vec3 a) { return a *= s; }
    GR_HD friend constexpr bool operator==(const Vec3& a, const Vec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
};

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;
using Vec3i = Vec3<std::int32_t>;
using Vec3l = Vec3<std::int64_t>;

template <class T>
GR_HD constexpr T dot(const Vec3<T>& a, const Vec3<T>& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

template <class T>
GR_HD constexpr Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class T>
GR_HD inline T length(const Vec3<T>& a) { return std::sqrt(dot(a, a)); }

template <class To, class From>
GR_HD constexpr Vec3<To> convert(const Vec3<From>& a) {
    return {static_cast<To>(a.x), static_cast<To>(a.y), static_cast<To>(a.z)};
}

/// Axis-aligned box, metres.
struct Box {
    Vec3d lower, upper;
    constexpr Vec3d extent() const { return upper - lower; }
};

/// Base of everything grainray throws; what() is one or two sentences for the user.
struct Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The input is wrong (exit status 2): names place, key, value and remedy; nothing was written.
struct InputError : Error {
    using Error::Error;
};

/// The simulation cannot go on (exit status 1): unstable, device lost, disk full; the last good state is kept.
struct SimulationError : Error {
    using Error::Error;
};

}  // namespace grainray
