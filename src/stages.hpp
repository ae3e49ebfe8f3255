// The stage functions of each executor; the files that define them are compiled once for each.
#pragma once

#include "state.hpp"

namespace grainray::cpu {
#include "stages.inc"
}
namespace grainray::cuda {
#include "stages.inc"
}
