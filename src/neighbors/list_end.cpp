// Stage: which particle ended the list, for the tuner of margins and interval (interval.hpp).
#include "dynamics/motion.hpp"
#include "exec/exec.hpp"
#include "stages.hpp"

namespace grainray::GRAINRAY_EXEC {
namespace {

struct Farther {
    GR_HD Leaver operator()(const Leaver& a, const Leaver& b) const { return a.share >= b.share ? a : b; }
};

}  // namespace

Leaver list_end(const State& s, const StepConstants& constants) {
    const auto near = s.particles.near.view(), built = s.built.view();
    const auto frame = s.frame.view();
    const auto body = s.particles.body.view();
    const float age = static_cast<float>(s.age.steps), to_units = constants.dt / static_cast<float>(s.particles.scale.unit);
    return reduce(s.size(), Leaver{}, [=] GR_HD(std::size_t i) {
        const Near p = near[i], b = built[i];
        const Vec3f way{static_cast<float>(wrapped(p.x, b.x)), static_cast<float>(wrapped(p.y, b.y)), static_cast<float>(wrapped(p.z, b.z))};
        const Vec3f moved = way - frame[i] * age, speed = body[i].velocity * to_units - frame[i];
        const float distance = length(moved), margin = fmaxf(static_cast<float>(b.radius), 1);
        return Leaver{distance / margin, margin, static_cast<float>(p.radius), distance > 0 ? dot(moved, speed) / distance : 0};
    }, Farther{});
}

}  // namespace grainray::GRAINRAY_EXEC
