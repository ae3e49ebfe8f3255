// Stage: motion, on the CPU; on CUDA it is the end of the fused step (methods/fused.cu). Particles are turned into arrays
// of one field, a few registers long, and all of a batch move at once.
#include "dynamics/motion.hpp"
#include "exec/exec.hpp"
#include "exec/lanes.hpp"
#include "exec/widest.hpp"
#include "stages.hpp"

namespace grainray::cpu {
namespace {

constexpr int width = 64;

struct alignas(64) Batch {
    float force[8][width];               ///< force, torque in quanta; [6], [7] unused
    float velocity[4][width];            ///< [3]: mass
    float spin[4][width];                ///< [3]: material's bits
    float left[3][width], frame[3][width];
    std::int32_t near[4][width];         ///< [3]: radius
    std::int32_t built[4][width];        ///< [3]: margin
    std::int32_t far[3][width];
    std::uint32_t insane[width], past[width];
};

struct Arrays {
    Near* near;
    Far* far;
    Body* body;
    Vec3f* left;
    Wrench* wrench;
    const Near* built;
    const Vec3f* frame;
};

template <int L, class T, int fields, class Where>
[[gnu::always_inline]] inline void load(T (&to)[fields][width], int l, const Where& where) {
    lanes::Vector<T, L> field[4];
    lanes::gather<L, T>(field, where);
    for (int a = 0; a < 4; ++a) lanes::store<L>(field[a], &to[a][l]);
}
template <int L, class T, class Where>
[[gnu::always_inline]] inline void store(const T (&from)[4][width], int l, const Where& where) {
    lanes::Vector<T, L> field[4];
    for (int a = 0; a < 4; ++a) lanes::load<L>(field[a], &from[a][l]);
    lanes::scatter<L, T>(field, where);
}

template <int L>
[[gnu::always_inline]] inline void gather(const Arrays& from, Batch& b) {
    alignas(64) float rows[width][8];
    for (int l = 0; l < width; ++l) {
        const std::int64_t *f = from.wrench[l].force;
        const lanes::Vector<float, 8> row{static_cast<float>(f[0]), static_cast<float>(f[1]), static_cast<float>(f[2]), static_cast<float>(f[3]),
                                          static_cast<float>(f[4]), static_cast<float>(f[5]), static_cast<float>(f[6]), static_cast<float>(f[7])};
        lanes::store<8>(row, rows[l]);
    }
    for (int l = 0; l < width; l += L) {
        load<L>(reinterpret_cast<float(&)[4][width]>(b.force[0]), l, [&](int k) { return rows[l + k]; });
        load<L>(reinterpret_cast<float(&)[4][width]>(b.force[4]), l, [&](int k) { return rows[l + k] + 4; });
        load<L>(b.velocity, l, [&](int k) { return &from.body[l + k].velocity.x; });
        load<L>(b.spin, l, [&](int k) { return &from.body[l + k].spin.x; });
        load<L>(b.near, l, [&](int k) { return &from.near[l + k].x; });
        load<L>(b.built, l, [&](int k) { return &from.built[l + k].x; });
    }
    for (int l = 0; l < width; ++l) {
        for (int a = 0; a < 3; ++a) b.left[a][l] = from.left[l][a];
        for (int a = 0; a < 3; ++a) b.frame[a][l] = from.frame[l][a];
        b.far[0][l] = from.far[l].x;
        b.far[1][l] = from.far[l].y;
        b.far[2][l] = from.far[l].z;
    }
}

template <int L>
[[gnu::always_inline]] inline void move(const Motion& motion, float age, Batch& b) {
#pragma GCC ivdep
    for (int l = 0; l < width; ++l) {
        Vec3f velocity{b.velocity[0][l], b.velocity[1][l], b.velocity[2][l]}, spin{b.spin[0][l], b.spin[1][l], b.spin[2][l]};
        Vec3f left{b.left[0][l], b.left[1][l], b.left[2][l]};
        motion.kick({b.force[0][l], b.force[1][l], b.force[2][l]}, {b.force[3][l], b.force[4][l], b.force[5][l]}, b.velocity[3][l], b.near[3][l],
                    velocity, spin, left);
        const Vec3f s = motion.way(velocity);
        const bool sane = Motion::sane(s);
        const Vec3l x = join(Near{b.near[0][l], b.near[1][l], b.near[2][l], 0}, Far{b.far[0][l], b.far[1][l], b.far[2][l]}) +
                        Vec3l{sane ? Motion::rounded(s.x) : 0, sane ? Motion::rounded(s.y) : 0, sane ? Motion::rounded(s.z) : 0};
        const Near p{near_of(x.x), near_of(x.y), near_of(x.z), b.near[3][l]};
        const Far f = far_of(x);
        const bool past = motion.past_margin(p, Near{b.built[0][l], b.built[1][l], b.built[2][l], b.built[3][l]},
                                             {b.frame[0][l], b.frame[1][l], b.frame[2][l]}, age);
        for (int a = 0; a < 3; ++a) {
            b.velocity[a][l] = velocity[a];
            b.spin[a][l] = spin[a];
            b.left[a][l] = left[a];
        }
        b.near[0][l] = p.x;
        b.near[1][l] = p.y;
        b.near[2][l] = p.z;
        b.far[0][l] = f.x;
        b.far[1][l] = f.y;
        b.far[2][l] = f.z;
        b.insane[l] = !sane;
        b.past[l] = sane & past;
    }
}

template <int L>
[[gnu::always_inline]] inline void scatter(const Batch& b, const Arrays& to) {
    for (int l = 0; l < width; l += L) {
        store<L>(b.velocity, l, [&](int k) { return &to.body[l + k].velocity.x; });
        store<L>(b.spin, l, [&](int k) { return &to.body[l + k].spin.x; });
        store<L>(b.near, l, [&](int k) { return &to.near[l + k].x; });
    }
    for (int l = 0; l < width; ++l) {
        to.left[l] = {b.left[0][l], b.left[1][l], b.left[2][l]};
        to.far[l] = {b.far[0][l], b.far[1][l], b.far[2][l]};
        to.wrench[l] = Wrench{};
    }
}

struct Integrate {
    Motion motion;
    Arrays arrays;
    View<std::uint32_t> flags;
    float age;  // steps since the list was built

    template <int L>
    [[gnu::always_inline]] void batch(std::size_t first) const {
        const Arrays at{arrays.near + first, arrays.far + first, arrays.body + first, arrays.left + first, arrays.wrench + first,
                        arrays.built + first, arrays.frame + first};
        Batch b;
        gather<L>(at, b);
        move<L>(motion, age, b);
        scatter<L>(b, at);
        std::uint32_t any = 0;
        for (int l = 0; l < width; ++l) any |= b.insane[l] | b.past[l];
        if (!any) return;
        for (std::uint32_t l = 0; l < width; ++l) {
            if (b.insane[l]) atomic_min(&flags[1], static_cast<std::uint32_t>(first) + l);
            if (b.past[l]) atomic_min(&flags[0], static_cast<std::uint32_t>(first) + l);
        }
    }
    void single(std::size_t i) const {
        Wrench& w = arrays.wrench[i];
        const bool finite = motion.advance(w, arrays.near[i], arrays.far[i], arrays.body[i], arrays.left[i]);
        w = Wrench{};
        if (!finite) atomic_min(&flags[1], static_cast<std::uint32_t>(i));
        else if (motion.past_margin(arrays.near[i], arrays.built[i], arrays.frame[i], age)) atomic_min(&flags[0], static_cast<std::uint32_t>(i));
    }
};

}  // namespace

void integrate(State& s, const StepConstants& constants, float trigger) {
    Particles& p = s.particles;
    const Integrate move{Motion(s, constants, trigger),
                         {p.near.data(), p.far.data(), p.body.data(), p.remainder.data(), s.wrench.data(), s.built.data(), s.frame.data()},
                         s.flags.view(), static_cast<float>(s.age.steps)};
    constexpr std::size_t chunk = 16 * width;
    const std::size_t n = s.size();
    for_each_share((n + chunk - 1) / chunk, [&](std::size_t c) {
        const std::size_t end = std::min(n, (c + 1) * chunk);
        std::size_t i = c * chunk;
        with_widest_registers([&]<int L>() __attribute__((always_inline)) {
            if constexpr (L > 4)  // narrow registers gain nothing
                for (; i + width <= end; i += width) move.batch<L>(i);
        });
        for (; i < end; ++i) move.single(i);
    });
}

}  // namespace grainray::cpu
