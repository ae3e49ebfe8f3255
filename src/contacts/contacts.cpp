// Stage: forces between particles, on the CPU; on CUDA they are part of the fused step (methods/fused.cu).
#include "stages.hpp"

#include "contacts/laws.hpp"
#include "exec/pairs_cpu.hpp"

namespace grainray::cpu {

void contacts(State& s, ContactLaw law, const StepConstants& constants) {
    const PairLoop loop{s.particles.near.view(), s.particles.far.view(), s.particles.body.view(), s.grains.offsets.view(),
                        s.grains.partners.view(), s.grains.history.view(), s.grain_parameters.view(), s.materials, s.block,
                        static_cast<float>(s.particles.scale.unit), 1.0 / s.quanta.force, 1.0 / s.quanta.torque, s.period,
                        s.wrench.view(), s.grains.touched.view()};
    with_law(law, constants.dt, [&](auto functor) { for_each_touching_pair(loop, functor); });
}

}  // namespace grainray::cpu
