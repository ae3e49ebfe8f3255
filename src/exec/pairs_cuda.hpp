// The pair loop on CUDA: a thread a particle over its full row (ListKind::blocked with blocks of one), sums in registers.
#pragma once

#include "contacts/pair.hpp"
#include "exec/cuda.hpp"

namespace grainray::cuda {

template <class Law>
void for_each_touching_pair(const PairLoop& loop, const Law& law) {
    const bool periodic = loop.periodic();
    for_each(loop.near.size, [=] GR_HD(std::size_t i) {
        const Near p = loop.near[i];
        const Body a = loop.body[i];
        Wrench sum{};
        for (std::uint64_t e = loop.offsets[i], end = loop.offsets[i + 1]; e < end; ++e) {
            const std::uint32_t j = loop.partners[e];
            const Near q = loop.near[j];
            const Separation s = periodic ? separation(p, loop.far[i], q, loop.far[j], loop.period) : separation(p, q);
            if (s.gap <= 0) {
                loop.history[e] = Vec3f{};
                continue;
            }
            const Body b = loop.body[j];
            Vec3f h = loop.history[e];
            const PairForce f = pair_force(law, s, p.radius, q.radius, a.velocity - b.velocity, a.spin, b.spin, 0.5f * (a.mass + b.mass),
                                           loop.of(a.material, b.material), loop.unit, h);
            loop.history[e] = h;
            for (int k = 0; k < 3; ++k) {
                sum.force[k] += quantize(f.force[k], loop.inverse_force);
                sum.torque[k] += quantize(f.torque_i[k], loop.inverse_torque);
            }
        }
        Wrench& w = loop.wrench[i];
        for (int k = 0; k < 3; ++k) {
            w.force[k] += sum.force[k];
            w.torque[k] += sum.torque[k];
        }
    });
}

}  // namespace grainray::cuda
