// The frames that a run left, and the scene they belong to.
#pragma once

#include <filesystem>
#include <vector>

#include "grainray/scene.hpp"

namespace grainray::cli {

/// The frames of a run's folder, or of a folder of frames, by number. Throws InputError: none, or not to be read.
std::vector<std::filesystem::path> frames_in(const std::filesystem::path& folder);

/// Simulated time of a frame, s: read without its particles where the format allows. Throws InputError.
double time_of(const std::filesystem::path& frame);

/// For each time the frame nearest to it. Throws InputError for a time before the first frame or after the last.
std::vector<std::filesystem::path> frames_at(const std::vector<std::filesystem::path>& frames, const std::vector<double>& times);
/// `count` times, evenly spread from the first frame to the last.
std::vector<double> spread_times(const std::vector<std::filesystem::path>& frames, std::size_t count);

/// The scene at `given`, or where that is empty the scene.toml of the frame's run. Throws InputError.
Scene scene_of(const std::filesystem::path& frame, const std::filesystem::path& given);

/// Makes a folder and those it lies in, if need be. Throws InputError.
void make_folder(const std::filesystem::path&);

}  // namespace grainray::cli
