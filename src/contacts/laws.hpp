// The contact laws. Adding one: its header, an entry of ContactLaw (contacts.hpp), a name and a case here.
#pragma once

#include <array>
#include <utility>

#include "contacts/linear.hpp"

namespace grainray {

inline constexpr std::array law_names{std::pair{ContactLaw::linear, "linear"}};

/// run(law) with the functor of a law.
template <class Run>
void with_law(ContactLaw law, float dt, const Run& run) {
    switch (law) {
        case ContactLaw::linear: return run(LinearLaw{dt});
    }
}

}  // namespace grainray
