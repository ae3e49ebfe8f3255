// Stage: forces of planes, on the CPU; on CUDA they are part of the fused step (methods/fused.cu). Candidates are turned into
// arrays of one field, and the law runs over a batch of them.
#include "boundary/plane_force.hpp"
#include "contacts/laws.hpp"
#include "exec/exec.hpp"
#include "exec/sums.hpp"
#include "exec/widest.hpp"
#include "stages.hpp"

namespace grainray::cpu {
namespace {

constexpr int width = 64;

struct alignas(64) Batch {
    std::uint32_t i[width];
    std::uint64_t entry[width];
    int size = 0;
    double x[3][width], normal[3][width], point[3][width], centre[3][width];
    float plane_velocity[3][width], plane_spin[3][width];
    std::int32_t radius[width];
    float velocity[3][width], mass[width], spin[3][width];
    float kn[width], kt[width], mu[width], cn[width], ct[width];
    float history[3][width], force[3][width], torque[3][width];
};

struct Walls {
    View<const Near> near;
    View<const Far> far;
    View<const Body> body;
    View<const std::uint64_t> offsets;
    View<const std::uint32_t> partners;
    View<Vec3f> history;
    View<const PlaneNow> planes;
    View<const PairParameters> parameters;  ///< materials x planes
    std::uint32_t plane_count;
    View<Wrench> wrench;
    double unit, fine;
    Sums sums;
};

template <class T>
[[gnu::always_inline]] inline void put(const Vec3<T>& v, T (&to)[3][width], int l) {
    to[0][l] = v.x;
    to[1][l] = v.y;
    to[2][l] = v.z;
}
template <class T>
[[gnu::always_inline]] inline Vec3<T> get(const T (&from)[3][width], int l) { return {from[0][l], from[1][l], from[2][l]}; }

[[gnu::always_inline]] inline void gather(const Walls& w, Batch& b) {
    for (int l = 0; l < b.size; ++l) {
        const std::uint32_t i = b.i[l], q = w.partners[b.entry[l]];
        const PlaneNow& plane = w.planes[q];
        const Body& body = w.body[i];
        put(convert<double>(join(w.near[i], w.far[i])) * w.fine, b.x, l);
        put(plane.normal, b.normal, l);
        put(plane.point, b.point, l);
        put(plane.centre, b.centre, l);
        put(plane.velocity, b.plane_velocity, l);
        put(plane.spin, b.plane_spin, l);
        put(body.velocity, b.velocity, l);
        put(body.spin, b.spin, l);
        b.radius[l] = w.near[i].radius;
        b.mass[l] = body.mass;
        const PairParameters& c = w.parameters[body.material * w.plane_count + q];
        b.kn[l] = c.kn;
        b.kt[l] = c.kt;
        b.mu[l] = c.mu;
        b.cn[l] = c.cn;
        b.ct[l] = c.ct;
        put(w.history[b.entry[l]], b.history, l);
    }
}

/// Lanes past b.size compute what nobody reads.
template <class Law>
[[gnu::always_inline]] inline void evaluate(const Law& law, double unit, Batch& b) {
    const int end = (b.size + 15) / 16 * 16;
#pragma GCC ivdep
    for (int l = 0; l < end; ++l) {
        const PlaneNow plane{get(b.point, l), get(b.normal, l), get(b.centre, l), get(b.plane_velocity, l), get(b.plane_spin, l), 0, 0};
        const Vec3d x = get(b.x, l);
        Vec3f h = get(b.history, l);
        const float overlap = plane_overlap(plane, x, b.radius[l], unit);
        const PlaneForce f = plane_force(law, plane, x, b.radius[l], unit, overlap, get(b.velocity, l), get(b.spin, l), b.mass[l],
                                         PairParameters{b.kn[l], b.kt[l], b.mu[l], b.cn[l], b.ct[l]}, h);
        const bool touching = overlap > 0;
        b.history[0][l] = touching ? h.x : 0.0f;
        b.history[1][l] = touching ? h.y : 0.0f;
        b.history[2][l] = touching ? h.z : 0.0f;
        b.force[0][l] = touching ? f.force.x : 0.0f;
        b.force[1][l] = touching ? f.force.y : 0.0f;
        b.force[2][l] = touching ? f.force.z : 0.0f;
        b.torque[0][l] = touching ? f.torque.x : 0.0f;
        b.torque[1][l] = touching ? f.torque.y : 0.0f;
        b.torque[2][l] = touching ? f.torque.z : 0.0f;
    }
}

template <int L>
[[gnu::always_inline]] inline void scatter(const Walls& w, const Batch& b) {
    for (int l = 0; l < b.size; l += L) {
        Rows<L> rows;
        rows.template turn<false>(w.sums, b.force, b.torque, l);
        for (int k = l; k < l + L && k < b.size; ++k) {
            w.history[b.entry[k]] = {b.history[0][k], b.history[1][k], b.history[2][k]};
            w.sums.add(w.wrench[b.i[k]], rows.at(k - l));
        }
    }
}

/// Particles [first, last).
template <int L, class Law>
[[gnu::always_inline]] inline void add_walls(const Walls& w, const Law& law, std::size_t first, std::size_t last) {
    Batch b{};
    const auto flush = [&]() __attribute__((always_inline)) {
        gather(w, b);
        evaluate(law, w.unit, b);
        scatter<L>(w, b);
        b.size = 0;
    };
    for (std::size_t i = first; i < last; ++i)
        for (std::uint64_t e = w.offsets[i], end = w.offsets[i + 1]; e < end; ++e) {
            b.i[b.size] = static_cast<std::uint32_t>(i);
            b.entry[b.size] = e;
            if (++b.size == width) flush();
        }
    flush();
}

}  // namespace

void walls(State& s, ContactLaw law, const StepConstants& constants) {
    const Walls w{s.particles.near.view(), s.particles.far.view(), s.particles.body.view(), s.walls.offsets.view(), s.walls.partners.view(),
                  s.walls.history.view(), s.planes.view(), s.wall_parameters.view(), s.plane_count, s.wrench.view(), s.particles.scale.unit,
                  s.particles.scale.fine(), Sums(1.0 / s.quanta.force, 1.0 / s.quanta.torque)};
    if (w.partners.size == 0) return;
    constexpr std::size_t chunk = 1024;
    const std::size_t n = s.size();
    with_law(law, constants.dt, [&](auto functor) {
        for_each_share((n + chunk - 1) / chunk, [&](std::size_t c) {
            with_widest_registers([&]<int L>() __attribute__((always_inline)) {
                add_walls<L>(w, functor, c * chunk, std::min(n, (c + 1) * chunk));
            });
        });
    });
}

}  // namespace grainray::cpu
