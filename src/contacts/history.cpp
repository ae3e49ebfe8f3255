// Stage: tangential histories from the old list into the new one, whatever order the particles and rows are in now.
#include "exec/exec.hpp"
#include "stages.hpp"

namespace grainray::GRAINRAY_EXEC {
namespace {

struct OldRows {
    View<const std::uint64_t> offsets;
    View<const std::uint32_t> partners;
    View<const Vec3f> history;

    GR_HD bool look_up(std::uint32_t row, std::uint32_t partner, Vec3f& found) const {
        for (std::uint64_t e = offsets[row]; e < offsets[row + 1]; ++e)
            if (partners[e] == partner) {
                found = history[e];
                return true;
            }
        return false;
    }
};

}  // namespace

void carry_pairs(const ContactList& old_list, const Array<std::uint32_t>& old_index, ContactList& list) {
    const OldRows old{old_list.offsets.view(), old_list.partners.view(), old_list.history.view()};
    const auto was = old_index.view();
    const auto offsets = list.offsets.view();
    const auto partners = list.partners.view();
    const auto history = list.history.view();
    for_each(list.offsets.size() - 1, [=] GR_HD(std::size_t i) {
        const std::uint32_t was_i = was[i];
        for (std::uint64_t e = offsets[i]; e < offsets[i + 1]; ++e) {
            const std::uint32_t was_j = was[partners[e]];
            Vec3f h;
            if (old.look_up(was_i, was_j, h)) history[e] = h;
            else if (old.look_up(was_j, was_i, h)) history[e] = -h;  // the pair stood in the other row
            else history[e] = Vec3f{};
        }
    });
}

void carry_walls(const ContactList& old_list, const Array<std::uint32_t>& old_index, ContactList& list) {
    const OldRows old{old_list.offsets.view(), old_list.partners.view(), old_list.history.view()};
    const auto was = old_index.view();
    const auto offsets = list.offsets.view();
    const auto partners = list.partners.view();
    const auto history = list.history.view();
    for_each(list.offsets.size() - 1, [=] GR_HD(std::size_t i) {
        for (std::uint64_t e = offsets[i]; e < offsets[i + 1]; ++e) {
            Vec3f h;
            history[e] = old.look_up(was[i], partners[e], h) ? h : Vec3f{};
        }
    });
}

}  // namespace grainray::GRAINRAY_EXEC
