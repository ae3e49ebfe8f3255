// The pair loop on the CPU. A block's list is filtered without branches into batches of touching pairs, laid out a field
// an array; the law runs over a batch in vector registers; sums go to both particles of a pair within the block.
// Blocks run in parallel and write only their own particles.
#pragma once

#include <cstring>

#include "contacts/pair.hpp"
#include "exec/cpu.hpp"

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define GRAINRAY_X86_LEVELS 1
#endif

namespace grainray::cpu {
namespace pairs {

inline constexpr int width = 64;

struct alignas(64) Batch {
    std::uint32_t i[width], j[width];
    std::uint64_t entry[width];
    std::int32_t x[width], y[width], z[width];
    std::int64_t gap[width];
    std::int32_t radius_i[width], radius_j[width];
    float velocity[3][width], spin_i[3][width], spin_j[3][width], mass[width];
    float kn[width], kt[width], mu[width], cn[width], ct[width];
    float history[3][width];
    float on_i[width][8], on_j[width][8];  ///< force, torque, 2 unused: a particle's sums as 8 lanes
    int size = 0;
};

// 8 lanes, whatever the registers: the compiler splits them where they are narrower.
using Float8 [[gnu::vector_size(32)]] = float;
using Double8 [[gnu::vector_size(64)]] = double;
using Long8 [[gnu::vector_size(64)]] = std::int64_t;

[[gnu::always_inline]] inline void gather(const PairLoop& loop, Batch& b) {
    for (int l = 0; l < b.size; ++l) {
        const Body& p = loop.body[b.i[l]];
        const Body& q = loop.body[b.j[l]];
        const Vec3f& h = loop.history[b.entry[l]];
        for (int a = 0; a < 3; ++a) {
            b.velocity[a][l] = p.velocity[a] - q.velocity[a];
            b.spin_i[a][l] = p.spin[a];
            b.spin_j[a][l] = q.spin[a];
            b.history[a][l] = h[a];
        }
        b.radius_i[l] = loop.near[b.i[l]].radius;
        b.radius_j[l] = loop.near[b.j[l]].radius;
        b.mass[l] = 0.5f * (p.mass + q.mass);
    }
}

[[gnu::always_inline]] inline void gather_parameters(const PairLoop& loop, Batch& b) {
    for (int l = 0; l < b.size; ++l) {
        const PairParameters& c = loop.of(loop.body[b.i[l]].material, loop.body[b.j[l]].material);
        b.kn[l] = c.kn;
        b.kt[l] = c.kt;
        b.mu[l] = c.mu;
        b.cn[l] = c.cn;
        b.ct[l] = c.ct;
    }
}

/// The law over a whole batch; lanes past b.size compute what nobody reads.
template <class Law>
[[gnu::always_inline]] inline void evaluate(const Law& law, float unit, Batch& b) {
    alignas(64) float force[3][width], torque_i[3][width], torque_j[3][width];
#pragma GCC ivdep
    for (int l = 0; l < width; ++l) {
        Vec3f h{b.history[0][l], b.history[1][l], b.history[2][l]};
        const PairForce f = pair_force(law, Separation{b.x[l], b.y[l], b.z[l], b.gap[l]}, b.radius_i[l], b.radius_j[l],
                                       {b.velocity[0][l], b.velocity[1][l], b.velocity[2][l]},
                                       {b.spin_i[0][l], b.spin_i[1][l], b.spin_i[2][l]},
                                       {b.spin_j[0][l], b.spin_j[1][l], b.spin_j[2][l]}, b.mass[l],
                                       PairParameters{b.kn[l], b.kt[l], b.mu[l], b.cn[l], b.ct[l]}, unit, h);
        b.history[0][l] = h.x;
        b.history[1][l] = h.y;
        b.history[2][l] = h.z;
        force[0][l] = f.force.x;
        force[1][l] = f.force.y;
        force[2][l] = f.force.z;
        torque_i[0][l] = f.torque_i.x;
        torque_i[1][l] = f.torque_i.y;
        torque_i[2][l] = f.torque_i.z;
        torque_j[0][l] = f.torque_j.x;
        torque_j[1][l] = f.torque_j.y;
        torque_j[2][l] = f.torque_j.z;
    }
    for (int l = 0; l < b.size; ++l)
        for (int a = 0; a < 3; ++a) {
            b.on_i[l][a] = force[a][l];
            b.on_j[l][a] = -force[a][l];
            b.on_i[l][3 + a] = torque_i[a][l];
            b.on_j[l][3 + a] = torque_j[a][l];
        }
}

/// quantize() of 8 values at once, added to a particle's sums.
[[gnu::always_inline]] inline void add(Wrench& w, const float* values, const Double8& scale) {
    Float8 f;
    std::memcpy(&f, values, sizeof f);
    Double8 v = __builtin_convertvector(f, Double8) * scale;
    const Double8 bound = Double8{} + quantum_bound, magic = Double8{} + quantum_magic;
    v = v < bound ? v : bound;
    v = v > -bound ? v : -bound;
    const Double8 shifted = v + magic;
    Long8 bits, zero, sums;
    std::memcpy(&bits, &shifted, sizeof bits);
    std::memcpy(&zero, &magic, sizeof zero);
    std::memcpy(&sums, &w, sizeof sums);
    sums += bits - zero;
    std::memcpy(&w, &sums, sizeof sums);
}

[[gnu::always_inline]] inline void scatter(const PairLoop& loop, const Batch& b, std::uint32_t block_end) {
    const double f = loop.inverse_force, t = loop.inverse_torque;
    const Double8 scale{f, f, f, t, t, t, 0, 0};
    for (int l = 0; l < b.size; ++l) {
        loop.history[b.entry[l]] = {b.history[0][l], b.history[1][l], b.history[2][l]};
        add(loop.wrench[b.i[l]], b.on_i[l], scale);
        if (b.j[l] - (block_end - loop.block) < loop.block)  // unsigned: j stands in this block
            add(loop.wrench[b.j[l]], b.on_j[l], scale);
    }
}

template <class Law>
[[gnu::always_inline]] inline void flush(const PairLoop& loop, const Law& law, Batch& b, std::uint32_t block_end) {
    gather(loop, b);
    if (loop.materials > 1) gather_parameters(loop, b);
    evaluate(law, loop.unit, b);
    scatter(loop, b, block_end);
    b.size = 0;
}

/// One block: rows [first, last); block_end is the block's nominal end, past the last particle where the block is cut.
template <bool periodic, class Law>
[[gnu::always_inline]] inline void run_block(const PairLoop& loop, const Law& law, std::uint32_t first, std::uint32_t last, std::uint32_t block_end) {
    Batch b{};
    if (loop.materials == 1) {
        const PairParameters& c = loop.parameters[0];
        for (int l = 0; l < width; ++l) {
            b.kn[l] = c.kn;
            b.kt[l] = c.kt;
            b.mu[l] = c.mu;
            b.cn[l] = c.cn;
            b.ct[l] = c.ct;
        }
    }
    constexpr std::uint64_t ahead = 24;
    const std::uint64_t entries = loop.partners.size;
    Vec3f dump;  // where pairs that do touch send their "no history"
    for (std::uint32_t i = first; i < last; ++i) {
        const Near p = loop.near[i];
        for (std::uint64_t e = loop.offsets[i], end = loop.offsets[i + 1]; e < end; ++e) {
            const std::uint32_t j = loop.partners[e];
            __builtin_prefetch(&loop.near[loop.partners[e + ahead < entries ? e + ahead : e]]);
            __builtin_prefetch(&loop.body[j]);
            __builtin_prefetch(&loop.wrench[j], 1);
            Separation s;
            if constexpr (periodic) s = separation(p, loop.far[i], loop.near[j], loop.far[j], loop.period);
            else s = separation(p, loop.near[j]);
            const bool touching = s.gap > 0;
            b.i[b.size] = i;
            b.j[b.size] = j;
            b.entry[b.size] = e;
            b.x[b.size] = s.x;
            b.y[b.size] = s.y;
            b.z[b.size] = s.z;
            b.gap[b.size] = s.gap;
            *(touching ? &dump : &loop.history[e]) = Vec3f{};
            b.size += touching;
            if (b.size == width) flush(loop, law, b, block_end);
        }
    }
    if (b.size) flush(loop, law, b, block_end);
}

template <bool periodic, class Law>
void block_any(const PairLoop& loop, const Law& law, std::uint32_t first, std::uint32_t last, std::uint32_t end) {
    run_block<periodic>(loop, law, first, last, end);
}
#ifdef GRAINRAY_X86_LEVELS
// The same source for wider registers: IEEE operations give the same bits at any width.
template <bool periodic, class Law>
[[gnu::target("arch=x86-64-v3")]] void block_v3(const PairLoop& loop, const Law& law, std::uint32_t first, std::uint32_t last, std::uint32_t end) {
    run_block<periodic>(loop, law, first, last, end);
}
template <bool periodic, class Law>
[[gnu::target("arch=x86-64-v4")]] void block_v4(const PairLoop& loop, const Law& law, std::uint32_t first, std::uint32_t last, std::uint32_t end) {
    run_block<periodic>(loop, law, first, last, end);
}
#endif

template <bool periodic, class Law>
auto best_block() {
#ifdef GRAINRAY_X86_LEVELS
    if (__builtin_cpu_supports("x86-64-v4")) return block_v4<periodic, Law>;
    if (__builtin_cpu_supports("x86-64-v3")) return block_v3<periodic, Law>;
#endif
    return block_any<periodic, Law>;
}

}  // namespace pairs

/// Adds every touching pair's force and torques to loop.wrench and brings the histories up to date.
template <class Law>
void for_each_touching_pair(const PairLoop& loop, const Law& law) {
    static const auto plain = pairs::best_block<false, Law>();
    static const auto periodic = pairs::best_block<true, Law>();
    const auto run = loop.periodic() ? periodic : plain;
    const std::size_t n = loop.near.size, blocks = (n + loop.block - 1) / loop.block;
    for_each(blocks, [&](std::size_t k) {
        const std::uint32_t first = static_cast<std::uint32_t>(k) * loop.block;
        run(loop, law, first, static_cast<std::uint32_t>(std::min<std::size_t>(n, std::size_t{first} + loop.block)), first + loop.block);
    }, 1);
}

}  // namespace grainray::cpu
