// Stage: margins. How far each particle may move before the list must be made again, and the points for the search.
//
// The world is cut into boxes at least as wide as any pair's reach. The mean velocity U around a box is the frame of the
// particles in it: motion that the surroundings share is no displacement. The list holds while
//   every particle's displacement, less U t, is below its own margin m_i (src/dynamics/integrate.cpp checks each step), and
//   t is below the list's limit, for which the shear between boxes is covered: particles of boxes c and c' drift apart by
//   |U_c - U_c'| t, and reach r_i + m_i + e_c with e_c = 1/2 t max |U_c - U_c'| over the boxes around covers it.
// So coherent motion is free, and a lone runaway has a wide margin that nobody else pays for.
#include "exec/exec.hpp"
#include "neighbors/cells/grid.hpp"
#include "stages.hpp"

namespace grainray::GRAINRAY_EXEC {
namespace {

/// Sums over the particles of one box: velocities in 1/16 units a step, their squares in 1024 units^2.
struct Sums {
    std::int64_t count, x, y, z, square;
};
/// What a box tells its particles, units a step.
struct Surroundings {
    Vec3f frame;
    float spread;  ///< standard deviation of the velocity
    float shear;   ///< 1/2 max |U_c - U_c'|
};

struct Boxes {
    neighbors::Grid grid;
    View<Sums> sums;
    View<Surroundings> around;

    GR_HD std::uint32_t of(const neighbors::Sphere& s) const { return grid.bucket(s); }

    /// visit(bucket) for a box and those around it; where an axis has few buckets some come twice, which harms nothing.
    template <class Visit>
    GR_HD void for_each_around(std::uint32_t bucket, const Visit& visit) const {
        const std::int32_t nx = grid.x.buckets, ny = grid.y.buckets, nz = grid.z.buckets, b = static_cast<std::int32_t>(bucket);
        const std::int32_t x = b % nx, y = b / nx % ny, z = b / nx / ny;
        for (int dz = -1; dz <= 1; ++dz)
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx)
                    visit(grid.row((y + dy + ny) % ny, (z + dz + nz) % nz) + static_cast<std::uint32_t>((x + dx + nx) % nx));
    }
};

constexpr float fastest = 1e9f;  // units a step; particles beyond it are reported by the integrator

GR_HD inline float held(float v) { return v < fastest ? (v > -fastest ? v : -fastest) : fastest; }

void sum_boxes(const Boxes& boxes, View<const neighbors::Sphere> spheres, View<const Body> body, float to_units) {
    for_each(spheres.size, [=] GR_HD(std::size_t i) {
        const Vec3f v{held(body[i].velocity.x * to_units), held(body[i].velocity.y * to_units), held(body[i].velocity.z * to_units)};
        Sums& s = boxes.sums[boxes.of(spheres[i])];
        const auto fixed = [](float f) { return static_cast<std::int64_t>(f); };
        atomic_add(&s.count, std::int64_t{1});
        atomic_add(&s.x, fixed(v.x * 16));
        atomic_add(&s.y, fixed(v.y * 16));
        atomic_add(&s.z, fixed(v.z * 16));
        atomic_add(&s.square, fixed(dot(v, v) * (1.0f / 1024)));
    });
}

void look_around(const Boxes& boxes) {
    for_each(boxes.sums.size, [=] GR_HD(std::size_t c) {
        double n = 0, x = 0, y = 0, z = 0, square = 0;
        boxes.for_each_around(static_cast<std::uint32_t>(c), [&](std::uint32_t b) {
            const Sums& s = boxes.sums[b];
            n += static_cast<double>(s.count);
            x += static_cast<double>(s.x);
            y += static_cast<double>(s.y);
            z += static_cast<double>(s.z);
            square += static_cast<double>(s.square);
        });
        if (n == 0) return;
        const double vx = x / n / 16, vy = y / n / 16, vz = z / n / 16, variance = square / n * 1024 - (vx * vx + vy * vy + vz * vz);
        boxes.around[c] = {{static_cast<float>(vx), static_cast<float>(vy), static_cast<float>(vz)}, sqrtf(static_cast<float>(variance > 0 ? variance : 0)), 0};
    });
    for_each(boxes.sums.size, [=] GR_HD(std::size_t c) {
        float most = 0;
        if (boxes.sums[c].count == 0) return;
        boxes.for_each_around(static_cast<std::uint32_t>(c), [&](std::uint32_t b) {
            if (boxes.sums[b].count) most = fmaxf(most, length(boxes.around[b].frame - boxes.around[c].frame));
        });
        boxes.around[c].shear = 0.5f * most;
    });
}

/// Floats for the search, relative to the periodic box where there is one; reach comes later.
void place_points(const State& s, View<neighbors::Sphere> spheres) {
    const auto near = s.particles.near.view();
    const auto far = s.particles.far.view();
    const double fine = s.particles.scale.fine();
    const Vec3l lower{s.period.x > 0 ? s.period_lower.x : 0, s.period.y > 0 ? s.period_lower.y : 0, s.period.z > 0 ? s.period_lower.z : 0};
    for_each(s.size(), [=] GR_HD(std::size_t i) {
        const Vec3d x = convert<double>(join(near[i], far[i]) - lower) * fine;
        spheres[i] = {static_cast<float>(x.x), static_cast<float>(x.y), static_cast<float>(x.z), 0};
    });
}

struct Larger {
    GR_HD float operator()(float a, float b) const { return a > b ? a : b; }
};

}  // namespace

void margins(State& s, const StepConstants& constants, const MarginRule& rule, Array<float>& points) {
    const std::size_t n = s.size();
    const double unit = s.particles.scale.unit;
    points.resize_discard(4 * n);
    s.built.resize_discard(n);
    s.frame.resize_discard(n);
    const View<neighbors::Sphere> spheres{reinterpret_cast<neighbors::Sphere*>(points.data()), n};
    place_points(s, spheres);

    const Vec3f period = convert<float>(convert<double>(s.period) * unit);
    const float largest = static_cast<float>(rule.most_units * unit);
    Boxes boxes{neighbors::make_grid(n / 8, 4 * largest, s.lower, s.upper, Vec3f{}, period), {}, {}};
    Array<Sums> sums(device, boxes.grid.buckets());
    Array<Surroundings> around(device, boxes.grid.buckets());
    sums.clear_bytes();
    around.clear_bytes();
    boxes.sums = sums.view();
    boxes.around = around.view();
    const auto body = s.particles.body.view();
    const float to_units = constants.dt / static_cast<float>(unit);
    sum_boxes(boxes, spheres, body, to_units);
    look_around(boxes);

    // Margin and shear together stay below the largest radius, or the near words would not tell neighbours apart.
    const float shear = reduce(around.size(), 0.0f, [=] GR_HD(std::size_t c) { return boxes.around[c].shear; }, Larger{});
    const float steps = fmaxf(1.0f, fminf(rule.interval, floorf(0.5f * rule.most_units / (shear + 1e-30f))));
    s.age.limit = static_cast<std::uint32_t>(steps);
    const float longest = fmaxf(fmaxf(fmaxf(fabsf(s.lower.x), fabsf(s.upper.x)), fmaxf(fabsf(s.lower.y), fabsf(s.upper.y))),
                                fmaxf(fmaxf(fabsf(s.lower.z), fabsf(s.upper.z)), fmaxf(period.x, fmaxf(period.y, period.z))));

    const auto near = s.particles.near.view(), built = s.built.view();
    const auto frame = s.frame.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        const Near q = near[i];
        const Surroundings& a = boxes.around[boxes.of(spheres[i])];
        const float own = length(body[i].velocity * to_units - a.frame) + rule.spread * a.spread;
        const float margin = fminf(own * steps + rule.least * static_cast<float>(q.radius), 0.5f * rule.most_units) + 1.0f;
        built[i] = {q.x, q.y, q.z, static_cast<std::int32_t>(margin)};
        frame[i] = a.frame;
        const float reach = static_cast<float>((static_cast<double>(q.radius) + built[i].radius + a.shear * steps) * unit);
        // The search is exact for the floats it is given: the last term covers what rounding to them may hide.
        spheres[i].reach = reach * 1.000002f + longest * 4e-7f;
    });
}

}  // namespace grainray::GRAINRAY_EXEC
