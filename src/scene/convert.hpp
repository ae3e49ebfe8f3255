// From toml++ to our own tree. Included by the two sources that parse TOML.
#pragma once

#include <toml++/toml.h>

#include "scene/value.hpp"

namespace grainray::scene {

using Origin = std::shared_ptr<const std::string>;

/// located: places carry the line and column of toml++; otherwise (a --set) the origin alone.
Value convert(const toml::node&, const Origin&, bool located);

}  // namespace grainray::scene
