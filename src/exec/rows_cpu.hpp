// Rows of contact candidates on the CPU: one after the other, as the search found them.
#pragma once

#include "exec/cpu.hpp"
#include "state.hpp"

namespace grainray::cpu {

struct Rows {
    View<const std::uint64_t> offsets;
    View<const std::uint32_t> partners;
    View<Vec3f> histories;

    explicit Rows(const ContactList& list) : offsets(list.offsets.view()), partners(list.partners.view()),
          histories{const_cast<Vec3f*>(list.history.data()), list.history.size()} {}

    std::uint32_t size(std::size_t i) const { return static_cast<std::uint32_t>(offsets[i + 1] - offsets[i]); }
    /// Of entry k of row i.
    std::uint32_t partner(std::size_t i, std::uint32_t k) const { return partners[offsets[i] + k]; }
    Vec3f history(std::size_t i, std::uint32_t k) const { return histories[offsets[i] + k]; }
};

/// What was found becomes the list's rows; `found` keeps the memory of the list before. carry.touches(i, j),
/// carry.history(i, j): see contacts/history.cpp.
template <class Carry>
void lay_out(NeighborList& found, const Carry& carry, ContactList& list) {
    found.offsets.swap(list.offsets);
    found.neighbors.swap(list.partners);
    list.history.resize_discard_slack(list.partners.size());
    list.touched.resize_discard_slack(list.partners.size());
    const auto touched = list.touched.view();
    const Rows rows(list);
    for_each(list.offsets.size() - 1, [=](std::size_t i) {
        for (std::uint64_t e = rows.offsets[i]; e < rows.offsets[i + 1]; ++e) {
            const std::uint32_t j = rows.partners[e];
            touched[e] = carry.touches(i, j);
            rows.histories[e] = touched[e] ? carry.history(i, j) : Vec3f{};
        }
    });
}

/// The list itself is what is kept of it.
inline void keep_live(ContactList& list, ContactList& kept) { std::swap(list, kept); }

}  // namespace grainray::cpu
