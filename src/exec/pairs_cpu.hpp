// The pair loop on the CPU. Stretches of a block's list are tested without branches, touching pairs are packed, and batches
// of them are laid out a field an array; the law runs over a batch in vector registers; sums go to both particles of a pair
// within the block. Blocks run in parallel and write only their own particles.
#pragma once

#include "exec/cpu.hpp"
#include "exec/sums.hpp"
#include "exec/touching.hpp"

namespace grainray::cpu {
namespace pairs {

inline constexpr int width = 64;  ///< pairs a batch

/// What the law needs of some touching pairs and what it makes of them, a field an array.
struct alignas(64) Batch {
    const std::uint32_t *i, *j, *entry;        ///< these are in a Touching
    const std::int32_t *x, *y, *z, *radius_i, *radius_j;
    int size = 0;
    float velocity[4][width];                  ///< of i against j; [3] is the sum of the masses
    float spin_i[4][width], spin_j[4][width];  ///< [3]: the material's bits
    float kn[width], kt[width], mu[width], cn[width], ct[width];
    float history[3][width];
    float force[3][width], torque_i[3][width], torque_j[3][width];
    std::uint64_t parameters = ~std::uint64_t{0};  ///< row of the parameter table that all lanes hold, if one

    [[gnu::always_inline]] void take(const Touching& t, int first) {
        i = t.i + first;
        j = t.j + first;
        entry = t.entry + first;
        x = t.x + first;
        y = t.y + first;
        z = t.z + first;
        radius_i = t.radius_i + first;
        radius_j = t.radius_j + first;
        size = std::min(width, t.size - first);
    }
};

/// Bodies are read whole and turned in registers; those of the next batch are sent for.
template <int L>
[[gnu::always_inline]] inline void gather(const PairLoop& loop, std::uint64_t start, Batch& b) {
    using Float = lanes::Vector<float, L>;
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

/// Most batches are of one pair of materials, the same as the last.
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

/// The float nearest to v, 0 <= v < 2^58, in the operations of AVX2, which converts no 64-bit integers: the low 6 bits of a
/// large v are joined into the 7th, where rounding to 24 bits only sees that there are some, and the rest is exact in double.
[[gnu::always_inline]] inline float nearest_float(std::int64_t v) {
    const std::uint64_t u = static_cast<std::uint64_t>(v), sticky = ((u & 63) + 63) & 64;
    const std::uint64_t w = u >> 32 ? (u | sticky) & ~std::uint64_t{63} : u;
    const double high = std::bit_cast<double>(w >> 32 | 0x4530000000000000u) - 0x1.00000001p84;  // 2^32 (w >> 32) - 2^52
    return static_cast<float>(high + std::bit_cast<double>((w & 0xffffffffu) | 0x4330000000000000u));
}

/// The law over a whole batch; lanes past b.size compute what nobody reads.
template <int L, class Law>
[[gnu::always_inline]] inline void evaluate(const Law& law, float unit, Batch& b) {
    const int end = (b.size + 15) / 16 * 16;
#pragma GCC ivdep
    for (int l = 0; l < end; ++l) {
        Vec3f h{b.history[0][l], b.history[1][l], b.history[2][l]};
        const std::int64_t x = b.x[l], y = b.y[l], z = b.z[l], radii = b.radius_i[l] + b.radius_j[l];
        const std::int64_t square = x * x + y * y + z * z, gap = radii * radii - square;
        const PairForce f = pair_force(law, b.x[l], b.y[l], b.z[l], L == 8 ? nearest_float(square) : static_cast<float>(square),
                                       L == 8 ? nearest_float(gap) : static_cast<float>(gap), b.radius_i[l], b.radius_j[l],
                                       {b.velocity[0][l], b.velocity[1][l], b.velocity[2][l]},
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
    const Sums sums(loop.inverse_force, loop.inverse_torque);
    Stretches stretches(loop, first);
    while (stretches.next(loop, loop.offsets[last])) {
        find<periodic, L>(loop, stretches, found);
        for (int done = 0; done < found.size; done += width) {
            b.take(found, done);
            gather<L>(loop, found.start, b);
            gather_parameters(loop, b);
            evaluate<L>(law, loop.unit, b);
            scatter<L>(loop, sums, found.start, b, block_end);
        }
    }
}

template <bool periodic, class Law>
void for_each_block(const PairLoop& loop, const Law& law) {
    const std::size_t n = loop.near.size, blocks = (n + loop.block - 1) / loop.block;
    for_each(blocks, [&](std::size_t k) {
        const std::uint32_t first = static_cast<std::uint32_t>(k) * loop.block, end = first + loop.block;
        const auto last = static_cast<std::uint32_t>(std::min<std::size_t>(n, std::size_t{first} + loop.block));
        with_widest_registers([&]<int L>() __attribute__((always_inline)) { run_block<periodic, L>(loop, law, first, last, end); });
    }, 1);
}

}  // namespace pairs

/// Adds every touching pair's force and torques to loop.wrench and brings the histories up to date.
template <class Law>
void for_each_touching_pair(const PairLoop& loop, const Law& law) {
    if (loop.periodic()) pairs::for_each_block<true>(loop, law);
    else pairs::for_each_block<false>(loop, law);
}

}  // namespace grainray::cpu
