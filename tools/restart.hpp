// Does a checkpoint belong to the scene that is to go on from it?
#pragma once

#include <filesystem>

#include "grainray/output.hpp"
#include "preflight.hpp"

namespace grainray::cli {

/// Throws InputError where the checkpoint is not one of this scene, or the scene asks for what it would not get:
/// particles, densities and the time step are those of the checkpoint.
void require_fit(const Scene&, const InitialState&, const Checkpoint&, const std::filesystem::path& file);
/// Adds a warning with the keys that act from now on and are not as before, and a note where no step is left.
void inspect_restart(const Scene&, const Checkpoint&, const RunRange&, Preflight&);

}  // namespace grainray::cli
