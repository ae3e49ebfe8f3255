// Stage: motion, on the CPU; on CUDA it is the end of the fused step (methods/fused.cu).
#include "dynamics/motion.hpp"
#include "exec/exec.hpp"
#include "stages.hpp"

namespace grainray::cpu {
namespace {

struct Integrate {
    Motion motion;
    View<Near> near;
    View<Far> far;
    View<Body> body;
    View<Vec3f> remainder;
    View<Wrench> wrench;
    View<const Near> built;
    View<const Vec3f> frame;
    View<std::uint32_t> flags;
    float age;  // steps since the list was built

    void operator()(std::size_t i) const {
        Wrench& w = wrench[i];
        const bool finite = motion.advance(w, near[i], far[i], body[i], remainder[i]);
        for (int a = 0; a < 3; ++a) w.force[a] = w.torque[a] = 0;
        if (!finite) atomic_min(&flags[1], static_cast<std::uint32_t>(i));
        else if (motion.past_margin(near[i], built[i], frame[i], age)) atomic_min(&flags[0], static_cast<std::uint32_t>(i));
    }
};

}  // namespace

void integrate(State& s, const StepConstants& constants, float trigger) {
    Particles& p = s.particles;
    for_each(s.size(), Integrate{Motion(s, constants, trigger), p.near.view(), p.far.view(), p.body.view(), p.remainder.view(), s.wrench.view(),
                                 s.built.view(), s.frame.view(), s.flags.view(), static_cast<float>(s.age.steps)}, 1024);
}

}  // namespace grainray::cpu
