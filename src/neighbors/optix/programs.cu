// The OptiX programs: rays of length 1e-16 and an intersection program a way of searching. No any-hit, no closest-hit; an
// intersection never reports a hit, so that the ray goes on to the next box.
//   payload 0  entries so far, from the left    1  from the right    2  the image the ray starts from
#include <optix_device.h>

#include "neighbors/optix/parameters.hpp"

using namespace grainray;
using neighbors::Sphere;
using neighbors::rays::Slots;
namespace rays = neighbors::rays;

extern "C" {
// As bytes, since a constant may have no constructor. OptiX fills it under this name.
__constant__ __align__(16) unsigned char launch_parameters[sizeof(optix::Parameters)];
}

namespace {

__device__ __forceinline__ const optix::Parameters& parameters() { return reinterpret_cast<const optix::Parameters&>(launch_parameters); }

__device__ __forceinline__ std::uint32_t ray_number() { return static_cast<std::uint32_t>(parameters().first) + optixGetLaunchIndex().x; }

__device__ __forceinline__ unsigned image_number(const Vec3i& shift) { return static_cast<unsigned>(shift.x + 1 + 3 * (shift.y + 1) + 9 * (shift.z + 1)); }
__device__ __forceinline__ Vec3i shift_of(unsigned image) {
    const int i = static_cast<int>(image);
    return {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
}

__device__ __forceinline__ Sphere read(const Sphere* s) {
    const float4 v = __ldg(reinterpret_cast<const float4*>(s));
    return {v.x, v.y, v.z, v.w};
}

__device__ __forceinline__ void cast(const Vec3f& start, unsigned& left, unsigned& right, unsigned image) {
    constexpr float third = 0.57735f;  // no zero in the direction: 0 * infinity on the face of a box is no number
    optixTrace(parameters().boxes, {start.x, start.y, start.z}, {third, third, third}, 0.0f, 1e-16f, 0.0f, OptixVisibilityMask(1),
               OPTIX_RAY_FLAG_DISABLE_ANYHIT | OPTIX_RAY_FLAG_DISABLE_CLOSESTHIT, 0, 1, 0, left, right, image);
}

__device__ __forceinline__ bool beyond(const Vec3f& c) {
    const Vec3f &lo = parameters().bounds.lower, &hi = parameters().bounds.upper;
    return c.x < lo.x || c.y < lo.y || c.z < lo.z || c.x > hi.x || c.y > hi.y || c.z > hi.z;
}

/// Whether a and b are near, seen through this image alone. Programs flush numbers below 1e-38 to zero, which could decide
/// between points closer than this: those are taken, and tested again where the rows are made.
__device__ __forceinline__ bool near(const Sphere& a, const Sphere& b) {
    constexpr float least = 1e-14f;
    const Vec3f& period = parameters().frame.period;
    if (a.reach + b.reach < least) parameters().doubtful[0] = 1;
    else if (!(parameters().periodic ? neighbors::pair_test(a, b, period) : neighbors::pair_test(a, b))) return false;
    return !parameters().periodic || rays::is_nearest(a, shift_of(optixGetPayload_2()), b, period);
}

__device__ __forceinline__ void add_left(std::uint32_t ray, std::uint32_t entry) {
    const Slots& s = parameters().slots;
    const unsigned c = optixGetPayload_0();
    if (c < s.room(ray)) s.entries[s.from_left(ray, c)] = entry;
    optixSetPayload_0(c + 1);
}

}  // namespace

/// A ray from each image of a source that may meet somebody.
extern "C" __global__ void __raygen__rays() {
    const std::uint32_t k = ray_number();
    const Sphere s = read(parameters().sources.data + k);
    const rays::Frame& frame = parameters().frame;
    unsigned left = 0, right = 0;
    const float beside = s.reach > parameters().classes.small ? parameters().classes.beside : 0;
    if (!parameters().periodic) {
        const Vec3f start = frame.point({s.x, s.y, s.z});
        cast({start.x + beside, start.y, start.z}, left, right, image_number({}));
    } else {
        rays::for_each_image(frame.period, [&](const Vec3i& shift) {
            const Vec3f start = frame.point(rays::image({s.x, s.y, s.z}, shift, frame.period));
            if (!beyond(start)) cast({start.x + beside, start.y, start.z}, left, right, image_number(shift));
        });
    }
    parameters().slots.left[k] = left;
    if (parameters().slots.two_sided()) parameters().slots.right[k] = right;
}

extern "C" __global__ void __miss__nothing() {}

/// Default: each pair found once.
extern "C" __global__ void __intersection__pairs() {
    const std::uint32_t k = ray_number(), box = optixGetPrimitiveIndex(), points = static_cast<std::uint32_t>(parameters().points.size);
    const std::uint32_t p = box < points ? box : parameters().larger[box - points];
    const Sphere a = read(parameters().sources.data + k), b = read(parameters().points.data + p);
    float dx = a.x - b.x;
    if (parameters().periodic && parameters().frame.period.x > 0) dx = neighbors::nearest_image(dx, parameters().frame.period.x);
    if (k != p && rays::finds(b, p, a, k, dx, parameters().classes) && near(a, b)) add_left(k, p);
}

/// Published: each ray finds all its neighbours, later points from the left, earlier ones from the right.
extern "C" __global__ void __intersection__published() {
    const std::uint32_t k = ray_number(), p = optixGetPrimitiveIndex();
    if (k == p || !near(read(parameters().sources.data + k), read(parameters().points.data + p))) return;
    const unsigned left = optixGetPayload_0(), right = optixGetPayload_1();
    const Slots& s = parameters().slots;
    const bool fits = left + right < s.room(k);
    if (p > k) {
        if (fits) s.entries[s.from_left(k, left)] = p;
        optixSetPayload_0(left + 1);
    } else {
        if (fits) s.entries[s.from_right(k, right)] = p;
        optixSetPayload_1(right + 1);
    }
}

extern "C" __global__ void __intersection__queries() {
    const std::uint32_t k = ray_number(), p = optixGetPrimitiveIndex();
    if (near(read(parameters().sources.data + k), read(parameters().points.data + p))) add_left(k, p);
}
