// Stage: forces between particles.
#include "stages.hpp"

#include "contacts/laws.hpp"
#include "exec/pairs.hpp"

namespace grainray::GRAINRAY_EXEC {

void contacts(State& s, ContactLaw law, const StepConstants& constants) {
    if (device == Device::cpu && s.age.steps == 0) {  // a new list
        s.grains.touched.resize_discard_slack(s.grains.partners.size());
        const auto touched = s.grains.touched.view();
        for_each(touched.size, [=] GR_HD(std::size_t e) { touched[e] = 1; });
    }
    const PairLoop loop{s.particles.near.view(), s.particles.far.view(), s.particles.body.view(), s.grains.offsets.view(),
                        s.grains.partners.view(), s.grains.history.view(), s.grain_parameters.view(), s.materials, s.block,
                        static_cast<float>(s.particles.scale.unit), 1.0 / s.quanta.force, 1.0 / s.quanta.torque, s.period,
                        s.wrench.view(), s.grains.touched.view()};
    with_law(law, constants.dt, [&](auto functor) { for_each_touching_pair(loop, functor); });
}

}  // namespace grainray::GRAINRAY_EXEC
