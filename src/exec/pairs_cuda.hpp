// The pair loop on CUDA: a thread sums what the neighbours in its full row do to its particle. Candidates are tested 32 at
// a time, with reads that do not wait for each other; then those that touch are evaluated, most lanes of a warp at once.
#pragma once

#include "contacts/pair.hpp"
#include "exec/rows_cuda.hpp"

namespace grainray::cuda {

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

    PairRows(const State& s, const PairParameters& only_parameters)
        : near(s.particles.near.data()), far(s.particles.far.data()), body(s.particles.body.data()), rows(s.grains),
          parameters(s.grain_parameters.data()), only(only_parameters), materials(s.materials), unit(static_cast<float>(s.particles.scale.unit)),
          inverse_force(static_cast<float>(1.0 / s.quanta.force)), inverse_torque(static_cast<float>(1.0 / s.quanta.torque)), period(s.period) {}

    template <bool periodic>
    __device__ Separation apart(const Near& p, const Far& f, const Near& q, std::uint32_t j) const {
        if constexpr (periodic) return separation(p, f, q, far[j], period);
        else return separation(p, q);
    }

    /// Adds the forces on particle i to `sum` and brings its histories up to date.
    template <bool periodic, class Law>
    __device__ void add(const Law& law, std::size_t i, const Near& p, const Far& f, const Body& a, Wrench& sum) const {
        const std::uint32_t size = rows.size(i);
        for (std::uint32_t start = 0; start < size; start += 32) {
            const std::uint64_t first = rows.entry(i, start);
            const std::uint32_t* const words = rows.partners.data + first;
            const std::uint32_t end = min(size - start, 32u);
            std::uint32_t touching = 0, live = 0;
#pragma unroll 4
            for (std::uint32_t k = 0; k < end; ++k) {
                const std::uint32_t word = words[k * slice_rows];
                live |= word >> 31 << k;
                touching |= std::uint32_t{apart<periodic>(p, f, near[word & ~live_bit], word & ~live_bit).gap > 0} << k;
            }
            for (std::uint32_t gone = live & ~touching; gone; gone &= gone - 1)
                rows.clear_history(first + (__ffs(gone) - 1) * slice_rows);
            // One ahead: the partner of the next contact is known, and its body on the way, while this one is evaluated.
            std::uint32_t k = lowest_bit(touching), j = touching ? words[k * slice_rows] & ~live_bit : 0;
            for (std::uint32_t rest = touching; rest;) {
                const std::uint64_t e = first + k * slice_rows;
                const bool was_live = live >> k & 1;
                const Body b = body[j];
                const Near q = near[j];
                Vec3f h = was_live ? rows.stored(e) : Vec3f{};
                rest &= rest - 1;
                const std::uint32_t next_k = lowest_bit(rest), next_j = rest ? words[next_k * slice_rows] & ~live_bit : j;
                const Separation s = apart<periodic>(p, f, q, j);
                asm volatile("prefetch.global.L1 [%0];" ::"l"(body + next_j));
                PairParameters c = only;
                if (materials > 1) c = parameters[a.material * materials + b.material];
                const PairForce force = pair_force(law, s, p.radius, q.radius, a.velocity - b.velocity, a.spin,
                                                   b.spin, 0.5f * (a.mass + b.mass), c, unit, h);
                if (was_live) rows.store(e, h);
                else rows.set_history(e, h);
                for (int axis = 0; axis < 3; ++axis) {
                    sum.force[axis] += quantize(force.force[axis], inverse_force);
                    sum.torque[axis] += quantize(force.torque_i[axis], inverse_torque);
                }
                k = next_k;
                j = next_j;
            }
        }
    }
};

}  // namespace grainray::cuda
