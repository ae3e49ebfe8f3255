// Arrays into another order, or a part of them.
#pragma once

#include "exec/exec.hpp"

namespace grainray::GRAINRAY_EXEC {

/// values[i] becomes what values[from[i]] was; as many are left as `from` has.
template <class T>
void permute(Array<T>& values, const Array<std::uint32_t>& from) {
    Array<T> moved(device, from.size());
    const auto old = values.view(), to = moved.view();
    const auto place = from.view();
    for_each(from.size(), [=] GR_HD(std::size_t i) { to[i] = old[place[i]]; });
    values.swap(moved);
}

}  // namespace grainray::GRAINRAY_EXEC
