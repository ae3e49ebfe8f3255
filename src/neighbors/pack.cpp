// Stage: the caller's points become one array of spheres, checked and wrapped into the periodic box.
#include "exec/exec.hpp"
#include "neighbors/backend.hpp"

namespace grainray::GRAINRAY_EXEC {
namespace {

struct Extent {
    float lo[3], hi[3];
    double min_reach, max_reach, sum_reach;
    std::uint32_t first_bad;  ///< a point that cannot be searched; ~0: none
};

struct Join {
    GR_HD Extent operator()(Extent a, const Extent& b) const {
        for (int k = 0; k < 3; ++k) {
            a.lo[k] = a.lo[k] < b.lo[k] ? a.lo[k] : b.lo[k];
            a.hi[k] = a.hi[k] > b.hi[k] ? a.hi[k] : b.hi[k];
        }
        a.min_reach = a.min_reach < b.min_reach ? a.min_reach : b.min_reach;
        a.max_reach = a.max_reach > b.max_reach ? a.max_reach : b.max_reach;
        a.sum_reach += b.sum_reach;
        a.first_bad = a.first_bad < b.first_bad ? a.first_bad : b.first_bad;
        return a;
    }
};

GR_HD inline float wrap(float x, float lower, float period) {
    if (!(period > 0)) return x;
    const float w = x - period * floorf((x - lower) / period);
    return w < lower + period ? (w < lower ? lower : w) : lower;
}

GR_HD inline bool finite(float v) { return v - v == 0; }

/// The points where they are, if nothing has to be changed about them.
const neighbors::Sphere* as_spheres(const Points& p, const neighbors::Request& request) {
    const bool aligned = reinterpret_cast<std::uintptr_t>(p.x) % alignof(neighbors::Sphere) == 0;
    const bool together = p.stride == 4 && p.y == p.x + 1 && p.z == p.x + 2 && p.reach == p.x + 3 && p.reach_stride == 4;
    return aligned && together && !request.periodic() ? reinterpret_cast<const neighbors::Sphere*>(p.x) : nullptr;
}

[[noreturn]] void refuse(const Points& points, std::uint32_t bad, const char* what) {
    const auto at = [&](const float* array, std::size_t stride) {
        float v = 0;
        detail::copy(Device::cpu, &v, device, array + bad * stride, sizeof v);
        return v;
    };
    const float reach = points.reach ? at(points.reach, points.reach_stride) : points.uniform_reach;
    throw InputError(std::string(what) + " " + std::to_string(bad) + " at (" + std::to_string(at(points.x, points.stride)) + ", " +
                     std::to_string(at(points.y, points.stride)) + ", " + std::to_string(at(points.z, points.stride)) +
                     ") with reach " + std::to_string(reach) + ": coordinates must be finite and the reach finite and not negative");
}

}  // namespace

void pack_points(const Points& points, const neighbors::Request& request, const char* what, neighbors::Packed& packed) {
    const std::size_t n = points.size;
    if (n >= 0xffffffffu) throw InputError(std::to_string(n) + " points: at most 4294967294 can be searched");
    const neighbors::Sphere* const in_place = as_spheres(points, request);
    packed.copied_spheres.resize_discard(in_place ? 0 : n);
    packed.copied_ids.resize_discard(points.ids ? 0 : n);
    const auto spheres = packed.copied_spheres.view();
    const auto ids = packed.copied_ids.view();
    packed.spheres = in_place ? View<const neighbors::Sphere>{in_place, n} : spheres;
    packed.ids = points.ids ? View<const std::uint32_t>{points.ids, n} : ids;
    packed.lower = packed.upper = {};
    packed.min_reach = packed.mean_reach = packed.max_reach = 0;
    if (n == 0) return;

    const Points p = points;
    const Vec3f lower = request.lower, period = request.period;
    const auto place = [=] GR_HD(std::size_t i) {
        const neighbors::Sphere s = in_place ? in_place[i] : neighbors::Sphere{p.x[i * p.stride], p.y[i * p.stride], p.z[i * p.stride],
                                                                              p.reach ? p.reach[i * p.reach_stride] : p.uniform_reach};
        const neighbors::Sphere w{wrap(s.x, lower.x, period.x), wrap(s.y, lower.y, period.y), wrap(s.z, lower.z, period.z), s.reach};
        if (spheres.size) spheres[i] = w;
        if (ids.size) ids[i] = static_cast<std::uint32_t>(i);
        const bool good = finite(s.x) && finite(s.y) && finite(s.z) && finite(s.reach) && s.reach >= 0;
        return Extent{{w.x, w.y, w.z}, {w.x, w.y, w.z}, s.reach, s.reach, s.reach, good ? 0xffffffffu : static_cast<std::uint32_t>(i)};
    };
    if (const Extents* const known = points.extents) {
        if (spheres.size || ids.size) for_each(n, [=] GR_HD(std::size_t i) { place(i); });
        packed.lower = known->lower;
        packed.upper = known->upper;
        packed.min_reach = known->min_reach;
        packed.mean_reach = known->mean_reach;
        packed.max_reach = known->max_reach;
        return;
    }
    constexpr float huge = 3.4e38f;
    const Extent none{{huge, huge, huge}, {-huge, -huge, -huge}, huge, 0, 0, 0xffffffffu};
    const Extent all = reduce(n, none, place, Join{});
    if (all.first_bad != 0xffffffffu) refuse(points, all.first_bad, what);
    packed.lower = {all.lo[0], all.lo[1], all.lo[2]};
    packed.upper = {all.hi[0], all.hi[1], all.hi[2]};
    packed.min_reach = static_cast<float>(all.min_reach);
    packed.max_reach = static_cast<float>(all.max_reach);
    packed.mean_reach = static_cast<float>(all.sum_reach / static_cast<double>(n));
}

}  // namespace grainray::GRAINRAY_EXEC
