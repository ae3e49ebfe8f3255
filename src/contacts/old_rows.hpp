// Histories of a list that is being replaced, row after row, found by partner.
#pragma once

#include "state.hpp"

namespace grainray {

struct OldRows {
    View<const std::uint64_t> offsets;
    View<const std::uint32_t> partners;
    View<const Vec3f> history;

    explicit OldRows(const ContactList& list) : offsets(list.offsets.view()), partners(list.partners.view()), history(list.history.view()) {}

    GR_HD bool look_up(std::uint32_t row, std::uint32_t partner, Vec3f& found) const {
        for (std::uint64_t e = offsets[row]; e < offsets[row + 1]; ++e)
            if (partners[e] == partner) {
                found = history[e];
                return true;
            }
        return false;
    }
};

}  // namespace grainray
