// Pictures of frames: spheres and planes, headless, to PNG.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "grainray/output.hpp"
#include "grainray/scene.hpp"

namespace grainray {

/// 8-bit RGB, rows from the top.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

/// Draws the frame's spheres and the scene's planes (where they are at frame.time) as RenderSettings say, with a colour
/// bar. color_by: speed, or any scalar frame field, or a vector field's magnitude. Throws InputError (unknown field).
Image render(const Frame&, const Scene&, const RenderSettings&);

/// Written to a temporary file and renamed. Throws SimulationError.
void write_png(const std::filesystem::path&, const Image&);

}  // namespace grainray
