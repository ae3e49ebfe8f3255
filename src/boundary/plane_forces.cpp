// Stage: forces of planes, on the CPU; on CUDA they are part of the fused step (methods/fused.cu).
#include "boundary/plane_contact.hpp"
#include "contacts/laws.hpp"
#include "exec/exec.hpp"
#include "stages.hpp"

namespace grainray::cpu {

void walls(State& s, ContactLaw law, const StepConstants& constants) {
    with_law(law, constants.dt, [&](auto functor) {
        const PlaneContacts contacts(s, functor);
        const Centres centres(s.particles);
        const auto body = s.particles.body.view();
        const auto wrench = s.wrench.view();
        for_each(s.size(), [=](std::size_t i) {
            if (contacts.offsets[i] != contacts.offsets[i + 1]) contacts.add(i, centres[i], centres.near[i].radius, body[i], 0, wrench[i]);
        });
    });
}

}  // namespace grainray::cpu
