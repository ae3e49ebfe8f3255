// Stage: margins. How far each particle may move before the list must be made again, and the points for the search.
//
// The world is cut into boxes 8 largest radii r wide. Each has a frame U: the mean velocity of the particles in and around it, as if 16
// more among them moved as all do on average, so that a lone runaway is no frame of its own. Motion that the surroundings share is no
// displacement. A list made for t steps holds while every particle's displacement, less U t, is below its own margin m
// (src/dynamics/integrate.cpp checks each step), because a pair drifts together or apart by at most m_i + m_j + t |U_i - U_j|.
// An ordinary particle has m <= k r, a runaway k r < m <= K r (`ordinary`, `widest`), and t is such that t |U - U'| <= (6 - 2 k) r for
// boxes that touch or have one box between. e_1 and e_2 are the largest t |U - U'| of a box and those that touch it, and those up to
// two away; an ordinary particle's reach is r_i + m_i + e_1 / 2, a runaway's r_i + m_i + max(e_1 / 2, e_2). A pair
//   in one box or two that touch is covered: both reaches have half of what their boxes drift;
//   with one box between is covered by a runaway's reach, which has all of it; two ordinary ones, 8 r apart, are kept so by
//   2 r + 2 k r + t |U - U'| <= 8 r;
//   farther apart, 16 r, is kept so by 2 r + 2 K r + t |U - U'| <= 16 r: t times the spread of all frames <= (14 - 2 K) r.
// What rounding may move the faces of boxes by (blur) is taken off 8 r and 16 r; wrapped and periodic axes have nearer boxes, never
// farther ones. A listed pair is never farther apart than 2 r + 4 K r + 3 (6 - 2 k) r = 21.5 r; from 22.6 r on squares of near words
// would overflow, and from 30 r on images would touch (contacts/pair.hpp).
// So coherent motion is free, and a lone runaway has a wide margin that nobody else pays for.
#include "exec/exec.hpp"
#include "neighbors/cells/grid.hpp"
#include "stages.hpp"

namespace grainray::GRAINRAY_EXEC {
namespace {

/// Sums over the particles of one box: velocities in 1/16 units a step, their squares in 2^20 units^2.
struct Sums {
    std::int64_t count, x, y, z, square;
};
/// What a box tells its particles, units a step.
struct Surroundings {
    Vec3f frame;
    float spread;  ///< standard deviation of the velocity
    float shear;   ///< max |U - U'| over the boxes that touch
    float beyond;  ///< the same up to two boxes away
};

struct Boxes {
    neighbors::Grid grid;
    View<Sums> sums;
    View<Surroundings> around;

    GR_HD std::uint32_t of(const neighbors::Sphere& s) const { return grid.bucket(s); }

    /// visit(bucket, ring) for the boxes up to `rings` away; on axes of few buckets some come twice, which harms nothing.
    template <class Visit>
    GR_HD void for_each_around(std::uint32_t bucket, int rings, const Visit& visit) const {
        const std::int32_t nx = grid.x.buckets, ny = grid.y.buckets, nz = grid.z.buckets, b = static_cast<std::int32_t>(bucket);
        const std::int32_t x = b % nx, y = b / nx % ny, z = b / nx / ny;
        const auto turn = [](std::int32_t v, std::int32_t n) { return (v % n + n) % n; };
        for (int dz = -rings; dz <= rings; ++dz)
            for (int dy = -rings; dy <= rings; ++dy)
                for (int dx = -rings; dx <= rings; ++dx) {
                    const bool near = dx * dx <= 1 && dy * dy <= 1 && dz * dz <= 1;
                    visit(grid.row(turn(y + dy, ny), turn(z + dz, nz)) + static_cast<std::uint32_t>(turn(x + dx, nx)), near ? 1 : 2);
                }
    }
};

// Largest radii: margins of ordinary particles and of runaways, and how far boxes near each other may drift apart in a list's life.
constexpr float ordinary = 1.75f, widest = 3, drift = 6 - 2 * ordinary;
static_assert(2 + 4 * widest + 3 * drift < 22.6f);
constexpr double typical = 16;   // particles at the mean velocity of all that count as part of any surroundings
constexpr float fastest = 1e9f;  // units a step; particles beyond it are reported by the integrator

GR_HD inline float held(float v) { return v < fastest ? (v > -fastest ? v : -fastest) : fastest; }

void sum_boxes(const Boxes& boxes, View<const neighbors::Sphere> spheres, View<const Body> body, float to_units) {
    for_each(spheres.size, [=] GR_HD(std::size_t i) {
        const Vec3f v{held(body[i].velocity.x * to_units), held(body[i].velocity.y * to_units), held(body[i].velocity.z * to_units)};
        const auto fixed = [](float f) { return static_cast<std::int64_t>(f); };
        Sums& s = boxes.sums[boxes.of(spheres[i])];
        atomic_add_together(&s.count, std::array<std::int64_t, 5>{1, fixed(v.x * 16), fixed(v.y * 16), fixed(v.z * 16), fixed(dot(v, v) * 0x1p-20f)});
    });
}

struct AddSums {
    GR_HD Sums operator()(const Sums& a, const Sums& b) const { return {a.count + b.count, a.x + b.x, a.y + b.y, a.z + b.z, a.square + b.square}; }
};

void look_around(const Boxes& boxes) {
    const Sums all = reduce(boxes.sums.size, Sums{}, [=] GR_HD(std::size_t c) { return boxes.sums[c]; }, AddSums{});
    const double share = typical / static_cast<double>(all.count > 0 ? all.count : 1);
    for_each(boxes.sums.size, [=] GR_HD(std::size_t c) {
        double n = 0, x = 0, y = 0, z = 0, square = 0;
        boxes.for_each_around(static_cast<std::uint32_t>(c), 1, [&](std::uint32_t b, int) {
            const Sums& s = boxes.sums[b];
            n += static_cast<double>(s.count);
            x += static_cast<double>(s.x);
            y += static_cast<double>(s.y);
            z += static_cast<double>(s.z);
            square += static_cast<double>(s.square);
        });
        if (n == 0) return;
        const double vx = x / n / 16, vy = y / n / 16, vz = z / n / 16, variance = square / n * 0x1p20 - (vx * vx + vy * vy + vz * vz);
        const auto frame = [=](double sum, std::int64_t of_all) { return static_cast<float>((sum + share * static_cast<double>(of_all)) / (n + typical) / 16); };
        boxes.around[c] = {{frame(x, all.x), frame(y, all.y), frame(z, all.z)}, sqrtf(static_cast<float>(variance > 0 ? variance : 0)), 0, 0};
    });
    for_each(boxes.sums.size, [=] GR_HD(std::size_t c) {
        if (boxes.sums[c].count == 0) return;
        float most[2] = {0, 0};
        boxes.for_each_around(static_cast<std::uint32_t>(c), 2, [&](std::uint32_t b, int ring) {
            if (boxes.sums[b].count) most[ring - 1] = fmaxf(most[ring - 1], length(boxes.around[b].frame - boxes.around[c].frame));
        });
        boxes.around[c].shear = most[0];
        boxes.around[c].beyond = fmaxf(most[0], most[1]);
    });
}

/// Largest figures over all boxes.
struct Extremes {
    float beyond;
    Vec3f slowest, fastest;  ///< of the frames, by axis
};
struct JoinExtremes {
    GR_HD Extremes operator()(Extremes a, const Extremes& b) const {
        a.beyond = fmaxf(a.beyond, b.beyond);
        for (int k = 0; k < 3; ++k) {
            a.slowest[k] = fminf(a.slowest[k], b.slowest[k]);
            a.fastest[k] = fmaxf(a.fastest[k], b.fastest[k]);
        }
        return a;
    }
};

/// Steps the list may last at most, by the bounds at the head of this file. `radius`: the largest, units; `blur`: what the
/// faces of the boxes may be off by rounding, radii.
float longest_life(const Boxes& boxes, float wanted, float radius, float blur) {
    const Extremes none{0, {fastest, fastest, fastest}, {-fastest, -fastest, -fastest}};
    const Extremes e = reduce(boxes.sums.size, none, [=] GR_HD(std::size_t c) {
        const Surroundings& a = boxes.around[c];
        return boxes.sums[c].count ? Extremes{a.beyond, a.frame, a.frame} : none;
    }, JoinExtremes{});
    const float spread = boxes.sums.size ? length(e.fastest - e.slowest) : 0, least = 1e-30f;
    const float bound = fminf((drift - blur) * radius / (e.beyond + least), (14 - 2 * widest - blur) * radius / (spread + least));
    return fmaxf(1.0f, floorf(fminf(wanted, bound)));
}

struct Widths {
    std::int64_t margins, radii;
};
struct AddWidths {
    GR_HD Widths operator()(const Widths& a, const Widths& b) const { return {a.margins + b.margins, a.radii + b.radii}; }
};
/// Margins of all over radii of all.
double mean_margin(View<const Near> near, View<const Near> built) {
    const Widths w = reduce(near.size, Widths{0, 0}, [=] GR_HD(std::size_t i) { return Widths{built[i].radius, near[i].radius}; }, AddWidths{});
    return w.radii ? static_cast<double>(w.margins) / static_cast<double>(w.radii) : 0;
}

/// What reaches have beyond the radii, of all over radii of all.
double mean_widening(View<const Near> near, View<const neighbors::Sphere> spheres, double unit) {
    const auto to_units = static_cast<float>(1 / unit);
    const Widths w = reduce(near.size, Widths{0, 0}, [=] GR_HD(std::size_t i) {
        return Widths{static_cast<std::int64_t>(spheres[i].reach * to_units) - near[i].radius, near[i].radius};
    }, AddWidths{});
    return w.radii ? static_cast<double>(w.margins) / static_cast<double>(w.radii) : 0;
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
    Boxes boxes{neighbors::make_grid(n / 8, 4 * largest, s.lower, s.upper, Vec3f{}, period, 1), {}, {}};
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

    const float longest = fmaxf(fmaxf(fmaxf(fabsf(s.lower.x), fabsf(s.upper.x)), fmaxf(fabsf(s.lower.y), fabsf(s.upper.y))),
                                fmaxf(fmaxf(fabsf(s.lower.z), fabsf(s.upper.z)), fmaxf(period.x, fmaxf(period.y, period.z))));

    const float steps = longest_life(boxes, rule.interval, rule.most_units, fminf(longest / largest * 5e-7f, drift - 0.1f));
    s.age.limit = static_cast<std::uint32_t>(steps);
    s.age.trigger = rule.trigger;

    const auto near = s.particles.near.view(), built = s.built.view();
    const auto frame = s.frame.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        const Near q = near[i];
        const Surroundings& a = boxes.around[boxes.of(spheres[i])];
        const float own = length(body[i].velocity * to_units - a.frame) + rule.spread * a.spread;
        const float margin = fminf(own * steps + rule.least * static_cast<float>(q.radius), widest / rule.trigger * rule.most_units);
        const float drifts = steps * (margin > ordinary * rule.most_units ? fmaxf(0.5f * a.shear, a.beyond) : 0.5f * a.shear);
        built[i] = {q.x, q.y, q.z, static_cast<std::int32_t>(margin)};
        frame[i] = a.frame;
        const float reach = static_cast<float>((static_cast<double>(q.radius) + built[i].radius + fminf(drifts, drift * rule.most_units)) * unit);
        // A list for one step may exceed the drift: it is used where it was made, and nothing drifts.
        // The search is exact for the floats it is given: the last term covers what rounding to them may hide.
        spheres[i].reach = reach * 1.000002f + longest * 4e-7f;
    });
    s.age.margin = mean_margin(near, built);
    s.age.widening = mean_widening(near, spheres, unit);
    s.age.widest = widest / rule.trigger * rule.most_units;
}

}  // namespace grainray::GRAINRAY_EXEC
