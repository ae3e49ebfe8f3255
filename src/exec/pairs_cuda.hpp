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
    __device__ Separation apart(const Near& p, const Far& f, std::uint32_t j) const {
        if constexpr (periodic) return separation(p, f, near[j], far[j], period);
        else return separation(p, near[j]);
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
                touching |= std::uint32_t{apart<periodic>(p, f, word & ~live_bit).gap > 0} << k;
            }
            for (std::uint32_t gone = live & ~touching; gone; gone &= gone - 1)
                rows.clear_history(first + (__ffs(gone) - 1) * slice_rows);
            for (std::uint32_t rest = touching; rest; rest &= rest - 1) {
                const std::uint32_t k = __ffs(rest) - 1;
                const std::uint64_t e = first + k * slice_rows;
                const std::uint32_t j = words[k * slice_rows] & ~live_bit;
                const bool was_live = live >> k & 1;
                Vec3f h = was_live ? rows.stored(e) : Vec3f{};
                const Body b = body[j];
                PairParameters c = only;
                if (materials > 1) c = parameters[a.material * materials + b.material];
                const PairForce force = pair_force(law, apart<periodic>(p, f, j), p.radius, near[j].radius, a.velocity - b.velocity, a.spin,
                                                   b.spin, 0.5f * (a.mass + b.mass), c, unit, h);
                if (was_live) rows.store(e, h);
                else rows.set_history(e, h);
                for (int axis = 0; axis < 3; ++axis) {
                    sum.force[axis] += quantize(force.force[axis], inverse_force);
                    sum.torque[axis] += quantize(force.torque_i[axis], inverse_torque);
                }
            }
        }
    }
};

}  // namespace grainray::cuda
