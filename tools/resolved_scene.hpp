// The scene of a run as one file that stands by itself: overrides applied, paths absolute.
#pragma once

#include <string>
#include <vector>

#include "grainray/scene.hpp"

namespace grainray::cli {

/// Text that parses to the same scene from any folder. The text as it was where there is nothing to change.
std::string resolved_text(const Scene&, const std::vector<std::string>& overrides);

}  // namespace grainray::cli
