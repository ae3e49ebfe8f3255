// The pair loop on the CPU. A block's list is filtered without branches into batches of touching pairs, laid out a field
// an array; the law runs over a batch in vector registers; sums go to both particles of a pair within the block.
// Blocks run in parallel and write only their own particles.
#pragma once

#include "exec/cpu.hpp"
#include "exec/lanes.hpp"
#include "exec/touching.hpp"

namespace grainray::cpu {
namespace pairs {

using lanes::Vector;

inline constexpr int width = 64;  ///< pairs a batch

/// What the law needs of some touching pairs and what it makes of them, a field an array.
struct alignas(64) Batch {
    const std::uint32_t *i, *j, *entry;
    const std::int32_t *x, *y, *z, *radius_i, *radius_j;
    int size = 0;
    float velocity[4][width];                ///< of i against j; [3] is the sum of the masses
    float spin_i[4][width], spin_j[4][width];  ///< [3]: the material's bits
    float kn[width], kt[width], mu[width], cn[width], ct[width];
    float history[3][width];
    float force[3][width], torque_i[3][width], torque_j[3][width];
    std::uint64_t parameters = ~std::uint64_t{0};  ///< row of the parameter table that all lanes hold, if one
};

template <int L>
[[gnu::always_inline]] inline void gather(const PairLoop& loop, std::uint64_t start, Batch& b) {
    using Float = Vector<float, L>;
    for (int l = 0; l < b.size; l += L) {
        for (int k = l; k < l + L; ++k) {
            __builtin_prefetch(&loop.body[b.j[k + width]]);
            __builtin_prefetch(&loop.wrench[b.j[k + width]], 1);
            const Vec3f& h = loop.history[start + b.entry[k]];
            for (int a = 0; a < 3; ++a) b.history[a][k] = h[a];
        }
        Float p[4], q[4];
        lanes::gather<L, float>(p, [&](int k) { return &loop.body[b.i[l + k]].velocity.x; });
        lanes::gather<L, float>(q, [&](int k) { return &loop.body[b.j[l + k]].velocity.x; });
        for (int a = 0; a < 3; ++a) lanes::store<L>(p[a] - q[a], &b.velocity[a][l]);
        lanes::store<L>(p[3] + q[3], &b.velocity[3][l]);
        lanes::gather<L, float>(p, [&](int k) { return &loop.body[b.i[l + k]].spin.x; });
        lanes::gather<L, float>(q, [&](int k) { return &loop.body[b.j[l + k]].spin.x; });
        for (int a = 0; a < 4; ++a) lanes::store<L>(p[a], &b.spin_i[a][l]);
        for (int a = 0; a < 4; ++a) lanes::store<L>(q[a], &b.spin_j[a][l]);
    }
}

[[gnu::always_inline]] inline void gather_parameters(const PairLoop& loop, Batch& b) {
    const auto put_at = [&](int l, const PairParameters& c) {
        b.kn[l] = c.kn;
        b.kt[l] = c.kt;
        b.mu[l] = c.mu;
        b.cn[l] = c.cn;
        b.ct[l] = c.ct;
    };
    std::uint32_t row[width];
    for (int l = 0; l < width; ++l)
        row[l] = std::bit_cast<std::uint32_t>(b.spin_i[3][l]) * loop.materials + std::bit_cast<std::uint32_t>(b.spin_j[3][l]);
    std::uint32_t other = 0;
    for (int l = 0; l < width; ++l) other |= row[l] ^ row[0];
    if (other) {
        for (int l = 0; l < b.size; ++l) put_at(l, loop.parameters[row[l]]);
        b.parameters = ~std::uint64_t{0};
    } else if (row[0] != b.parameters) {
        for (int l = 0; l < width; ++l) put_at(l, loop.parameters[row[0]]);
        b.parameters = row[0];
    }
}

/// The law over a whole batch; lanes past b.size compute what nobody reads.
template <class Law>
[[gnu::always_inline]] inline void evaluate(const Law& law, float unit, Batch& b) {
    const int end = (b.size + 15) / 16 * 16;
#pragma GCC ivdep
    for (int l = 0; l < end; ++l) {
        Vec3f h{b.history[0][l], b.history[1][l], b.history[2][l]};
        const Separation s = separation(b.x[l], b.y[l], b.z[l], std::int64_t{b.radius_i[l]} + b.radius_j[l]);
        const PairForce f = pair_force(law, s, b.radius_i[l], b.radius_j[l], {b.velocity[0][l], b.velocity[1][l], b.velocity[2][l]},
                                       {b.spin_i[0][l], b.spin_i[1][l], b.spin_i[2][l]},
                                       {b.spin_j[0][l], b.spin_j[1][l], b.spin_j[2][l]}, 0.5f * b.velocity[3][l],
                                       PairParameters{b.kn[l], b.kt[l], b.mu[l], b.cn[l], b.ct[l]}, unit, h);
        b.history[0][l] = h.x;
        b.history[1][l] = h.y;
        b.history[2][l] = h.z;
        b.force[0][l] = f.force.x;
        b.force[1][l] = f.force.y;
        b.force[2][l] = f.force.z;
        b.torque_i[0][l] = f.torque_i.x;
        b.torque_i[1][l] = f.torque_i.y;
        b.torque_i[2][l] = f.torque_i.z;
        b.torque_j[0][l] = f.torque_j.x;
        b.torque_j[1][l] = f.torque_j.y;
        b.torque_j[2][l] = f.torque_j.z;
    }
}

/// Quads of low and high in turn: [low 0, high 0, low 1, high 1 ...].
template <int L, int half, class V, std::size_t... k>
[[gnu::always_inline]] inline void interleave(const V& low, const V& high, V& to, std::index_sequence<k...>) {
    to = __builtin_shufflevector(low, high, (k / 8 * 4 + k % 4 + (k & 4) / 4 * L + half * L / 2)...);
}

/// quantize() and the sums of whole particles, 8 lanes at once.
struct Sums {
    Vector<double, 8> magic;  ///< quantum_magic quanta: adding it rounds to whole quanta
    float most_force, most_torque;

    explicit Sums(const PairLoop& loop)
        : most_force(static_cast<float>(quantum_bound / loop.inverse_force)), most_torque(static_cast<float>(quantum_bound / loop.inverse_torque)) {
        const double f = quantum_magic / loop.inverse_force, t = quantum_magic / loop.inverse_torque;
        magic = Vector<double, 8>{f, f, f, t, t, t, t, t};
    }
    [[gnu::always_inline]] void add(Wrench& w, const float* row) const {
        using Long = Vector<std::int64_t, 8>;
        const Vector<double, 8> shifted = Vector<double, 8>{row[0], row[1], row[2], row[3], row[4], row[5], row[6], row[7]} + magic;
        Long sums;
        lanes::load<8>(sums, w.force);
        sums += (Long)shifted - (Long)magic;
        lanes::store<8>(sums, w.force);
    }
};

/// Within +-bound; NaN becomes the bound, as in quantize().
template <class V>
[[gnu::always_inline]] inline void hold(V& v, float bound) {
    const V most = V{} + bound;
    v = v < most ? v : most;
    v = v > -most ? v : -most;
}

/// Forces and torques of L pairs as rows of 8; that of pair l is at(l).
template <int L>
struct Rows {
    alignas(64) float row[L][8];
    [[gnu::always_inline]] const float* at(unsigned l) const { return row[(l & 3) * (L / 4) + l / 4]; }
    template <bool other>
    [[gnu::always_inline]] void turn(const Sums& sums, const float (&force)[3][width], const float (&torque)[3][width], int l) {
        Vector<float, L> low[4], high[4];
        for (int a = 0; a < 3; ++a) {
            lanes::load<L>(low[a], &force[a][l]);
            if (other) low[a] = -low[a];
            hold(low[a], sums.most_force);
        }
        lanes::load<L>(low[3], &torque[0][l]);
        lanes::load<L>(high[0], &torque[1][l]);
        lanes::load<L>(high[1], &torque[2][l]);
        hold(low[3], sums.most_torque);
        hold(high[0], sums.most_torque);
        hold(high[1], sums.most_torque);
        high[2] = high[3] = Vector<float, L>{};
        lanes::transpose(low);
        lanes::transpose(high);
        for (int m = 0; m < 4; ++m) {
            float* to = row[m * (L / 4)];
            if constexpr (L == 4) {
                lanes::store<L>(low[m], to);
                lanes::store<L>(high[m], to + 4);
            } else {
                Vector<float, L> first, second;
                interleave<L, 0>(low[m], high[m], first, std::make_index_sequence<L>());
                interleave<L, 1>(low[m], high[m], second, std::make_index_sequence<L>());
                lanes::store<L>(first, to);
                lanes::store<L>(second, to + L);
            }
        }
    }
};

template <int L>
[[gnu::always_inline]] inline void scatter(const PairLoop& loop, const Sums& sums, std::uint64_t start, const Batch& b, std::uint32_t block_end) {
    Wrench outside{};  // the other half of a pair that leaves the block
    Wrench* const wrench = loop.wrench.data;
    Vec3f* const history = loop.history.data + start;
    const std::uint32_t block = loop.block, block_start = block_end - block;
    for (int l = 0; l < b.size; l += L) {
        Rows<L> on_i, on_j;
        on_i.template turn<false>(sums, b.force, b.torque_i, l);
        on_j.template turn<true>(sums, b.force, b.torque_j, l);
        for (int k = l; k < l + L && k < b.size; ++k) {
            history[b.entry[k]] = {b.history[0][k], b.history[1][k], b.history[2][k]};
            sums.add(wrench[b.i[k]], on_i.at(k - l));
            const bool inside = b.j[k] - block_start < block;  // unsigned: j stands in this block
            sums.add(*(inside ? &wrench[b.j[k]] : &outside), on_j.at(k - l));
        }
    }
}

/// One block: rows [first, last); block_end is the block's nominal end, past the last particle where the block is cut.
template <bool periodic, int L, class Law>
[[gnu::always_inline]] inline void run_block(const PairLoop& loop, const Law& law, std::uint32_t first, std::uint32_t last, std::uint32_t block_end) {
    Batch b{};
    Touching found{};
    const Sums sums(loop);
    Stretches stretches(loop, first);
    while (stretches.next(loop, loop.offsets[last])) {
        if constexpr (!periodic && L == 16) find_touching_v4(loop, stretches, found);
        else find_touching<periodic>(loop, stretches, found);
        for (int done = 0; done < found.size; done += width) {
            b.i = found.i + done;
            b.j = found.j + done;
            b.entry = found.entry + done;
            b.x = found.x + done;
            b.y = found.y + done;
            b.z = found.z + done;
            b.radius_i = found.radius_i + done;
            b.radius_j = found.radius_j + done;
            b.size = std::min(width, found.size - done);
            gather<L>(loop, found.start, b);
            gather_parameters(loop, b);
            evaluate(law, loop.unit, b);
            scatter<L>(loop, sums, found.start, b, block_end);
        }
    }
}

template <bool periodic, class Law>
void block_any(const PairLoop& loop, const Law& law, std::uint32_t first, std::uint32_t last, std::uint32_t end) {
    run_block<periodic, 4>(loop, law, first, last, end);
}
#ifdef GRAINRAY_X86_LEVELS
// The same source for wider registers: IEEE operations give the same bits at any width.
template <bool periodic, class Law>
[[gnu::target("arch=x86-64-v3")]] void block_v3(const PairLoop& loop, const Law& law, std::uint32_t first, std::uint32_t last, std::uint32_t end) {
    run_block<periodic, 8>(loop, law, first, last, end);
}
template <bool periodic, class Law>
[[gnu::target("arch=x86-64-v4")]] void block_v4(const PairLoop& loop, const Law& law, std::uint32_t first, std::uint32_t last, std::uint32_t end) {
    run_block<periodic, 16>(loop, law, first, last, end);
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
