// The pair loop on CUDA: a thread sums what the neighbours in its full row do to its particle. Candidates are tested 32 at
// a time, with reads that do not wait for each other; then those that touch are evaluated, most lanes of a warp at once.
#pragma once

#include "contacts/pair.hpp"
#include "exec/rows_cuda.hpp"

namespace grainray::cuda {

/// What a row needs to give its new contacts columns.
struct Settling {
    std::uint32_t* words;         ///< of the row, 32 apart
    std::uint32_t* numbers;       ///< of the slice's entries: 1 + spare column; 0: none
    std::uint32_t* spares_taken;
    std::uint32_t spares, own;    ///< columns

    /// Spare column for entry k of the slice. False where there is none left.
    __device__ bool take_spare(std::uint32_t k) const {
        if (__ldcg(&numbers[k])) return true;
        const std::uint32_t taken = atomicAdd(spares_taken, 1u);
        if (taken >= spares) return false;
        atomicCAS(&numbers[k], 0u, taken + 1);  // where another row was first, this column stays empty
        return true;
    }
};

/// A column for each entry that begins to touch. Those beyond the slice's own columns, `outside`, change places with entries
/// that have one and do not touch; what then remains takes spare columns. Bit k: entry k. Returns which touch then; 0 where a
/// spare column is missing: nothing but the order of the row has changed then.
__device__ inline std::uint64_t settle(const Settling s, std::uint64_t touching, std::uint64_t outside) {
    for (std::uint64_t room = ~touching & ~(~std::uint64_t{0} << s.own); outside && room; outside &= outside - 1, room &= room - 1) {
        std::uint32_t &a = s.words[lowest_bit(outside) * slice_rows], &b = s.words[lowest_bit(room) * slice_rows];
        const std::uint32_t partner = a;
        a = b;
        b = partner;
        touching ^= (outside & (0 - outside)) | (room & (0 - room));
    }
    for (; outside; outside &= outside - 1)
        if (!s.take_spare(lowest_bit(outside))) return 0;
    return touching;
}

inline constexpr unsigned pair_threads = 128;  ///< of a block that sums rows

/// Sums of a block's threads: force, then torque. In shared memory, because registers are scarce.
using Sums = std::int64_t[6][pair_threads];

struct PairRows {
    const Near* __restrict__ near;
    const Far* __restrict__ far;
    const Body* __restrict__ body;
    Rows rows;
    const PairParameters* __restrict__ parameters;
    PairParameters only;   ///< where there is one material
    std::uint32_t materials;
    float unit;
    float inverse_force, inverse_torque;
    Vec3l period;
    std::uint32_t* spares_taken;
    std::uint32_t spares;

    PairRows(State& s, const PairParameters& only_parameters)
        : near(s.particles.near.data()), far(s.particles.far.data()), body(s.particles.body.data()), rows(s.grains),
          parameters(s.grain_parameters.data()), only(only_parameters), materials(s.materials), unit(static_cast<float>(s.particles.scale.unit)),
          inverse_force(static_cast<float>(1.0 / s.quanta.force)), inverse_torque(static_cast<float>(1.0 / s.quanta.torque)), period(s.period),
          spares_taken(s.flags.data() + spares_flag), spares(static_cast<std::uint32_t>(s.grains.spare_history.size() / slice_rows)) {}

    template <bool periodic>
    __device__ Separation apart(const Near& p, const Far& f, const Near& q, std::uint32_t j) const {
        if constexpr (periodic) return separation(p, f, q, far[j], period);
        else return separation(p, q);
    }

    /// Which of up to 64 entries touch and which of them have a history: bit k of entry k.
    struct Chunk {
        std::uint64_t touching = 0, live = 0;
    };

    template <bool periodic>
    __device__ Chunk tested(const Near& p, const Far& f, std::uint32_t* words, std::uint32_t end) const {
        struct { std::uint32_t touching, live; } c{};
#pragma unroll 4
        for (std::uint32_t k = 0; k < end; ++k) {
            const std::uint32_t word = words[k * slice_rows];
            c.live |= word >> 31 << k;
            c.touching |= std::uint32_t{apart<periodic>(p, f, near[word & ~live_bit], word & ~live_bit).gap > 0} << k;
        }
        for (std::uint32_t gone = c.live & ~c.touching; gone; gone &= gone - 1) words[lowest_bit(gone) * slice_rows] &= ~live_bit;
        return {c.touching, c.live & c.touching};
    }

    /// Where the row of particle `lane` of a slice stands: numbers of 32 bits, because registers are scarce.
    struct Row {
        std::uint32_t slots, columns, own, lane;
    };
    __device__ std::uint32_t* word(const Row& row, std::uint32_t k) const {
        return rows.partners.data + (std::uint64_t{row.slots + k} * slice_rows + row.lane);
    }
    __device__ float* own_column(const Row& row, std::uint32_t k) const {
        return rows.own + (std::uint64_t{row.columns + k} * column_floats + row.lane);
    }
    __device__ float* column(const Row& row, std::uint32_t k) const {
        if (k < row.own) return own_column(row, k);
        const std::uint32_t number = __ldcg(&rows.spares[row.slots + k]);  // past L1: another row of the slice may just have written it
        return rows.spare + (std::uint64_t{number - 1} * column_floats + row.lane);
    }

    /// Forces and histories of the entries from `start` on that touch. column_of(entry): where its history is.
    template <bool periodic, class Mask, class Law, class Column>
    __device__ void evaluate(const Law& law, const Row& row, std::uint32_t start, Mask touching, const Column& column_of, const Near& p,
                             const Far& f, const Body& a, Sums& sums) const {
        // One ahead: the partner of the next contact is known, and its body on the way, while this one is evaluated.
        std::uint32_t k = start + lowest_bit(touching), partner = touching ? *word(row, k) : 0;
        while (touching) {
            float* const history = column_of(k);
            const std::uint32_t j = partner & ~live_bit;
            const Body b = body[j];
            const Near q = near[j];
            Vec3f h = partner & live_bit ? Rows::stored(history) : Vec3f{};
            touching &= touching - 1;
            const std::uint32_t next_k = start + lowest_bit(touching), next = touching ? *word(row, next_k) : partner;
            const Separation s = apart<periodic>(p, f, q, j);
            asm volatile("prefetch.global.L1 [%0];" ::"l"(body + (next & ~live_bit)));
            PairParameters c = only;
            if (materials > 1) c = parameters[a.material * materials + b.material];
            const PairForce force = pair_force(law, s, p.radius, q.radius, a.velocity - b.velocity, a.spin, b.spin,
                                               0.5f * (a.mass + b.mass), c, unit, h);
            Rows::store(history, h);
            if (!(partner & live_bit)) *word(row, k) = partner | live_bit;
            for (int axis = 0; axis < 3; ++axis) {
                sums[axis][threadIdx.x] += quantize(force.force[axis], inverse_force);
                sums[3 + axis][threadIdx.x] += quantize(force.torque_i[axis], inverse_torque);
            }
            k = next_k;
            partner = next;
        }
    }

    /// Adds the forces on particle i to `sum` and brings its histories up to date. False where a history finds no column: then
    /// none has been changed.
    template <bool periodic, class Law>
    __device__ bool add(const Law& law, std::uint32_t i, const Near& p, const Far& f, const Body& a, Wrench& sum) const {
        const std::uint32_t slice = i / slice_rows, size = rows.size(i);
        const auto first = static_cast<std::uint32_t>(rows.columns[slice]);
        const Row row{static_cast<std::uint32_t>(rows.starts[slice] / slice_rows), first, static_cast<std::uint32_t>(rows.columns[slice + 1]) - first, i % slice_rows};
        __shared__ Sums sums;
        for (auto& of_axis : sums) of_axis[threadIdx.x] = 0;
        bool room = true;
        for (std::uint32_t start = 0; start < size; start += 64) {
            Chunk chunk = tested<periodic>(p, f, word(row, start), min(size - start, 32u));
            if (size - start > 32) {
                const Chunk high = tested<periodic>(p, f, word(row, start + 32), min(size - start - 32, 32u));
                chunk.touching |= high.touching << 32;
                chunk.live |= high.live << 32;
            }
            if (row.own < settling_width) {
                const std::uint64_t outside = (chunk.touching & ~chunk.live) >> row.own << row.own;
                if (outside) {
                    chunk.touching = settle({word(row, 0), &rows.spares[row.slots], spares_taken, spares, row.own}, chunk.touching, outside);
                    room = chunk.touching;
                }
            }
            // Most by far, and apart from the rest: a loop with a load past L1 lets lanes go on by themselves (YIELD) after it.
            const auto usual = static_cast<std::uint32_t>(row.own < 32 ? chunk.touching & ((1u << row.own) - 1) : chunk.touching);
            evaluate<periodic>(law, row, start, usual, [&](std::uint32_t k) { return own_column(row, k); }, p, f, a, sums);
            if (const std::uint64_t rest = chunk.touching ^ usual)
                evaluate<periodic>(law, row, start, rest, [&](std::uint32_t k) { return column(row, k); }, p, f, a, sums);
        }
        for (int axis = 0; axis < 3; ++axis) {
            sum.force[axis] += sums[axis][threadIdx.x];
            sum.torque[axis] += sums[3 + axis][threadIdx.x];
        }
        return room;
    }
};

}  // namespace grainray::cuda
