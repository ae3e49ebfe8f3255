// Stages: which planes a particle may meet while a list lasts, and, on the CPU, their forces.
#include "boundary/plane_contact.hpp"
#include "contacts/old_rows.hpp"
#include "exec/exec.hpp"
#include "stages.hpp"

namespace grainray::GRAINRAY_EXEC {
namespace {

/// Could plane q touch particle i before the list's limit? Uses bounds on both motions only.
struct Reachable {
    Centres centres;
    View<const Near> built;
    View<const Vec3f> frame;
    View<const PlaneNow> planes;
    double unit, seconds, steps;

    GR_HD bool operator()(std::size_t i, std::size_t q) const {
        const PlaneNow& plane = planes[q];
        const Vec3d x = centres[i];
        const double gap = dot(plane.normal, x - plane.point) - centres.near[i].radius * unit;
        const double own = (static_cast<double>(length(frame[i])) * steps + 2.0 * built[i].radius) * unit;  // 2: trigger "published"
        const double turn = plane.reach_spin * (length(x - plane.centre) + own);
        return gap < (own + (plane.reach_speed + turn) * seconds) * (1 + 1e-9) + unit;
    }
};

}  // namespace

void list_walls(State& s, const StepConstants& constants, const ContactList& old_list, const Array<std::uint32_t>& old_index) {
    const Reachable reachable{Centres(s.particles), s.built.view(), s.frame.view(), s.planes.view(), s.particles.scale.unit,
                              static_cast<double>(constants.dt) * s.age.limit, static_cast<double>(s.age.limit)};
    const std::size_t n = s.size(), planes = s.plane_count;
    s.walls.offsets.resize_discard(n + 1);
    s.walls.offsets.clear_bytes();
    const auto offsets = s.walls.offsets.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        std::uint64_t count = 0;
        for (std::size_t q = 0; q < planes; ++q) count += reachable(i, q);
        offsets[i] = count;
    });
    s.walls.partners.resize_discard_slack(starts_of_rows(offsets));
    s.walls.history.resize_discard_slack(s.walls.partners.size());
    const OldRows old(old_list);
    const OldIndex was(old_index);
    const auto partners = s.walls.partners.view();
    const auto history = s.walls.history.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        std::uint64_t slot = offsets[i];
        for (std::uint32_t q = 0; slot < offsets[i + 1]; ++q) {
            if (!reachable(i, q)) continue;
            Vec3f h;
            partners[slot] = q;
            history[slot++] = old.look_up(was[i], q, h) ? h : Vec3f{};
        }
    });
}

}  // namespace grainray::GRAINRAY_EXEC
