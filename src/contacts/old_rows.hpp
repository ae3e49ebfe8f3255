// Histories of a list that is being replaced, row after row, found by partner.
#pragma once

#include "state.hpp"

namespace grainray {

/// Row of the old lists that a particle has.
struct OldIndex {
    View<const std::uint32_t> of;  ///< empty: its own number

    explicit OldIndex(const Array<std::uint32_t>& index) : of(index.view()) {}
    GR_HD std::uint32_t operator[](std::size_t i) const { return of.size ? of[i] : static_cast<std::uint32_t>(i); }
};

struct OldRows {
    View<const std::uint64_t> offsets;
    View<const std::uint32_t> partners;
    View<const Vec3f> history;
    View<const KeptPair> kept;  ///< instead of partners and history, where there are any

    explicit OldRows(const ContactList& list) : offsets(list.offsets.view()), partners(list.partners.view()), history(list.history.view()), kept(list.kept.view()) {}

    GR_HD bool look_up(std::uint32_t row, std::uint32_t partner, Vec3f& found) const {
        return kept.size ? look_up(row, [&](std::uint64_t e) { return kept[e]; }, partner, found)
                         : look_up(row, [&](std::uint64_t e) { return KeptPair{partners[e], history[e]}; }, partner, found);
    }

private:
    template <class Entry>
    GR_HD bool look_up(std::uint32_t row, const Entry& entry, std::uint32_t partner, Vec3f& found) const {
        for (std::uint64_t e = offsets[row]; e < offsets[row + 1]; ++e) {
            const KeptPair pair = entry(e);
            if (pair.partner != partner) continue;
            found = pair.history;
            return true;
        }
        return false;
    }
};

}  // namespace grainray
