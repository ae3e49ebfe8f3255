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
struct alignas(16) Surroundings {
    Vec3f frame;
    float spread;  ///< standard deviation of the velocity; negative: nobody is in the box
    float shear;   ///< max |U - U'| over the boxes that touch
    float beyond;  ///< the same up to two boxes away
};

struct Boxes {
    neighbors::Grid grid;
    View<Sums> sums;
    View<Surroundings> around;

    GR_HD std::uint32_t of(const neighbors::Sphere& s) const { return grid.bucket(s); }

    /// visit(bucket, touches) for the boxes up to `rings` away; on axes of few buckets some come twice, which harms nothing.
    template <int rings, class Visit>
    GR_HD void for_each_around(std::uint32_t bucket, const Visit& visit) const {
        constexpr int across = 2 * rings + 1;
        const std::int32_t nx = grid.x.buckets, ny = grid.y.buckets, nz = grid.z.buckets, b = static_cast<std::int32_t>(bucket);
        const std::int32_t x = b % nx, y = b / nx % ny, z = b / nx / ny;
        std::uint32_t xs[across];
        for (int k = 0; k < across; ++k) xs[k] = static_cast<std::uint32_t>(turn(x + k - rings, nx));
        const auto touches = [](int k) { return k >= rings - 1 && k <= rings + 1; };
        for (int k = 0; k < across; ++k)
            for (int j = 0; j < across; ++j) {
                const std::uint32_t row = grid.row(turn(y + j - rings, ny), turn(z + k - rings, nz));
                for (int i = 0; i < across; ++i) visit(row + xs[i], touches(i) && touches(j) && touches(k));
            }
    }
    /// Back into an axis of n boxes, from up to 2 outside of it.
    GR_HD static std::int32_t turn(std::int32_t v, std::int32_t n) {
        while (v < 0) v += n;
        while (v >= n) v -= n;
        return v;
    }
};

// Largest radii: margins of ordinary particles and of runaways, and how far boxes near each other may drift apart in a list's life.
constexpr float ordinary = 1.75f, widest = 3, drift = 6 - 2 * ordinary;
static_assert(2 + 4 * widest + 3 * drift < 22.6f);
constexpr double typical = 16;   // particles at the mean velocity of all that count as part of any surroundings
constexpr float fastest = 1e9f;  // units a step; particles beyond it are reported by the integrator

GR_HD inline float held(float v) { return v < fastest ? (v > -fastest ? v : -fastest) : fastest; }

struct AddSums {
    GR_HD Sums operator()(const Sums& a, const Sums& b) const { return {a.count + b.count, a.x + b.x, a.y + b.y, a.z + b.z, a.square + b.square}; }
};

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

/// Bounds of the points that the search gets, m.
struct Bounds {
    Vec3f lower, upper;
};
struct JoinBounds {
    GR_HD Bounds operator()(Bounds a, const Bounds& b) const {
        for (int k = 0; k < 3; ++k) {
            a.lower[k] = fminf(a.lower[k], b.lower[k]);
            a.upper[k] = fmaxf(a.upper[k], b.upper[k]);
        }
        return a;
    }
};
GR_HD inline float largest_coordinate(const Bounds& b) {
    float most = 0;
    for (int k = 0; k < 3; ++k) most = fmaxf(most, fmaxf(fabsf(b.lower[k]), fabsf(b.upper[k])));
    return most;
}

/// Sums over all particles, units, and the reaches there are, m.
struct Widths {
    std::int64_t margins, widenings, radii;  ///< widening: what a reach has beyond the radius
    float least_reach, largest_reach;
};
struct AddWidths {
    GR_HD Widths operator()(const Widths& a, const Widths& b) const {
        return {a.margins + b.margins, a.widenings + b.widenings, a.radii + b.radii, fminf(a.least_reach, b.least_reach), fmaxf(a.largest_reach, b.largest_reach)};
    }
};

/// What is true of all, one result after the other; the host reads it when the margins are there.
struct Whole {
    Bounds bounds;
    Sums sums;
    Extremes extremes;
    float longest;  ///< coordinate or period, m
    double steps;   ///< that the list may last
    Widths widths;
};

/// Floats for the search, relative to the periodic box where there is one (reach comes later), their bounds, and the sums of the boxes.
void place_points(const State& s, const Boxes& boxes, float to_units, View<neighbors::Sphere> spheres, Whole* whole) {
    const auto near = s.particles.near.view();
    const auto far = s.particles.far.view();
    const auto body = s.particles.body.view();
    const double fine = s.particles.scale.fine();
    const Vec3l lower{s.period.x > 0 ? s.period_lower.x : 0, s.period.y > 0 ? s.period_lower.y : 0, s.period.z > 0 ? s.period_lower.z : 0};
    constexpr float huge = 3.4e38f;
    reduce_into(&whole->bounds, s.size(), Bounds{{huge, huge, huge}, {-huge, -huge, -huge}}, [=] GR_HD(std::size_t i) {
        const Vec3f x = convert<float>(convert<double>(join(near[i], far[i]) - lower) * fine);
        const neighbors::Sphere sphere{x.x, x.y, x.z, 0};
        spheres[i] = sphere;
        const Vec3f v{held(body[i].velocity.x * to_units), held(body[i].velocity.y * to_units), held(body[i].velocity.z * to_units)};
        const auto fixed = [](float f) { return static_cast<std::int64_t>(f); };
        atomic_add_together(&boxes.sums[boxes.of(sphere)].count,
                            std::array<std::int64_t, 5>{1, fixed(v.x * 16), fixed(v.y * 16), fixed(v.z * 16), fixed(dot(v, v) * 0x1p-20f)});
        return Bounds{x, x};
    }, JoinBounds{});
}

void look_around(const Boxes& boxes, Whole* whole) {
    reduce_into(&whole->sums, boxes.sums.size, Sums{}, [=] GR_HD(std::size_t c) { return boxes.sums[c]; }, AddSums{});
    for_each(boxes.sums.size, [=] GR_HD(std::size_t c) {
        const Sums all = whole->sums;
        const double share = typical / static_cast<double>(all.count > 0 ? all.count : 1);
        Sums near{};
        if (boxes.sums[c].count)
            boxes.for_each_around<1>(static_cast<std::uint32_t>(c), [&](std::uint32_t b, bool) {
                if (boxes.sums[b].count) near = AddSums{}(near, boxes.sums[b]);
            });
        if (near.count == 0) {
            boxes.around[c] = {{}, -1, 0, 0};
            return;
        }
        const auto n = static_cast<double>(near.count), x = static_cast<double>(near.x), y = static_cast<double>(near.y), z = static_cast<double>(near.z),
                   square = static_cast<double>(near.square);
        const double vx = x / n / 16, vy = y / n / 16, vz = z / n / 16, variance = square / n * 0x1p20 - (vx * vx + vy * vy + vz * vz);
        const auto frame = [=](double sum, std::int64_t of_all) { return static_cast<float>((sum + share * static_cast<double>(of_all)) / (n + typical) / 16); };
        boxes.around[c] = {{frame(x, all.x), frame(y, all.y), frame(z, all.z)}, sqrtf(static_cast<float>(variance > 0 ? variance : 0)), 0, 0};
    });
    const Extremes none{0, {fastest, fastest, fastest}, {-fastest, -fastest, -fastest}};
    reduce_into(&whole->extremes, boxes.sums.size, none, [=] GR_HD(std::size_t c) {
        const Vec3f own = boxes.around[c].frame;
        if (boxes.around[c].spread < 0) return none;
        float touching = 0, near = 0;  // squares
        boxes.for_each_around<2>(static_cast<std::uint32_t>(c), [&](std::uint32_t b, bool touches) {
            const Surroundings a = boxes.around[b];
            const Vec3f apart = a.frame - own;
            const float square = a.spread < 0 ? 0 : dot(apart, apart);
            near = fmaxf(near, square);
            if (touches) touching = fmaxf(touching, square);
        });
        const float beyond = sqrtf(near);
        boxes.around[c].shear = sqrtf(touching);
        boxes.around[c].beyond = beyond;
        return Extremes{beyond, own, own};
    }, JoinExtremes{});
}

/// Steps the list may last at most, by the bounds at the head of this file. `radius`: the largest, units; `blur`: what the
/// faces of the boxes may be off by rounding, radii.
GR_HD inline float longest_life(const Extremes& e, float wanted, float radius, float blur) {
    const float spread = length(e.fastest - e.slowest), least = 1e-30f;
    const float bound = fminf((drift - blur) * radius / (e.beyond + least), (14 - 2 * widest - blur) * radius / (spread + least));
    return fmaxf(1.0f, floorf(fminf(wanted, bound)));
}

}  // namespace

Extents margins(State& s, const StepConstants& constants, const MarginRule& rule, Array<float>& points) {
    const std::size_t n = s.size();
    const double unit = s.particles.scale.unit;
    points.resize_discard(4 * n);
    s.built.resize_discard(n);
    s.frame.resize_discard(n);
    const View<neighbors::Sphere> spheres{reinterpret_cast<neighbors::Sphere*>(points.data()), n};

    // The grid wraps around, so bounds of the list before do as well.
    const Vec3f period = convert<float>(convert<double>(s.period) * unit);
    const float largest = static_cast<float>(rule.most_units * unit);
    Boxes boxes{neighbors::make_grid(n / 8, 4 * largest, s.lower, s.upper, Vec3f{}, period, 1), {}, {}};
    Array<Sums> sums(device, boxes.grid.buckets());
    Array<Surroundings> around(device, boxes.grid.buckets());
    Array<Whole> wholes(device, 1);
    Whole* const whole = wholes.data();
    sums.clear_bytes();
    boxes.sums = sums.view();
    boxes.around = around.view();
    const float to_units = constants.dt / static_cast<float>(unit);
    place_points(s, boxes, to_units, spheres, whole);
    look_around(boxes, whole);

    const float extent = fmaxf(largest_coordinate({s.lower, s.upper}), fmaxf(period.x, fmaxf(period.y, period.z)));
    const auto flags = s.flags.view();
    for_each(1, [=] GR_HD(std::size_t) {
        whole->longest = fmaxf(extent, largest_coordinate(whole->bounds));
        whole->steps = longest_life(whole->extremes, rule.interval, rule.most_units, fminf(whole->longest / largest * 5e-7f, drift - 0.1f));
        flags[0] = flags[1] = ~0u;
        flags[2] = 0;
    });

    const auto near = s.particles.near.view(), built = s.built.view();
    const auto frame = s.frame.view();
    const auto body = s.particles.body.view();
    const auto units = static_cast<float>(1 / unit);
    reduce_into(&whole->widths, n, Widths{0, 0, 0, 3.4e38f, 0}, [=] GR_HD(std::size_t i) {
        const Near q = near[i];
        const Surroundings& a = boxes.around[boxes.of(spheres[i])];
        const float steps = static_cast<float>(whole->steps), own = length(body[i].velocity * to_units - a.frame) + rule.spread * a.spread;
        const float margin = fminf(own * steps + rule.least * static_cast<float>(q.radius), widest / rule.trigger * rule.most_units);
        const float drifts = steps * (margin > ordinary * rule.most_units ? fmaxf(0.5f * a.shear, a.beyond) : 0.5f * a.shear);
        const auto kept = static_cast<std::int32_t>(margin);
        built[i] = {q.x, q.y, q.z, kept};
        frame[i] = a.frame;
        // A list for one step may exceed the drift: it is used where it was made, and nothing drifts.
        // The search is exact for the floats it is given: the last term covers what rounding to them may hide.
        const float exact = static_cast<float>((static_cast<double>(q.radius) + kept + fminf(drifts, drift * rule.most_units)) * unit);
        const float reach = exact * 1.000002f + whole->longest * 4e-7f;
        spheres[i].reach = reach;
        return Widths{kept, static_cast<std::int64_t>(reach * units) - q.radius, q.radius, reach, reach};
    }, AddWidths{});

    const Whole w = fetch(whole);
    const auto over_radii = [&](std::int64_t sum) { return w.widths.radii ? static_cast<double>(sum) / static_cast<double>(w.widths.radii) : 0; };
    s.lower = w.bounds.lower;
    s.upper = w.bounds.upper;
    s.age.limit = static_cast<std::uint32_t>(w.steps);
    s.age.trigger = rule.trigger;
    s.age.margin = over_radii(w.widths.margins);
    s.age.widening = over_radii(w.widths.widenings);
    s.age.widest = widest / rule.trigger * rule.most_units;
    const auto reaches = static_cast<double>(w.widths.radii + w.widths.widenings) * unit;
    return {w.bounds.lower, w.bounds.upper, w.widths.least_reach, static_cast<float>(reaches / static_cast<double>(n)), w.widths.largest_reach};
}

}  // namespace grainray::GRAINRAY_EXEC
