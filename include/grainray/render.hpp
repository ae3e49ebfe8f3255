// Pictures of frames: spheres, planes, meshes and terrain, headless, to PNG.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "grainray/output.hpp"
#include "grainray/scene.hpp"

namespace grainray {

/// 8-bit RGB, rows from the top.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

/// Pictures of one scene: meshes and terrain are loaded once. Camera and colours suit each frame, or all that were included.
class Renderer {
public:
    /// Throws InputError where a setting is wrong, or a mesh or the terrain cannot be read.
    Renderer(const Scene&, const RenderSettings&);
    ~Renderer();

    /// From now on one camera and one range of colours, which suit every frame included so far. Throws InputError.
    void include(const Frame&);
    struct ColorRange {
        double low, high;
    };
    /// The range that the included frames share; none where the colours are no quantity.
    std::optional<ColorRange> shared_colors() const;

    /// The frame's spheres, the scene's planes and meshes where they are at frame.time, its terrain as a block cut out
    /// about them, a colour bar and the time. Throws InputError (unknown field).
    Image draw(const Frame&) const;
    /// `count` frames side by side on one picture of the size of the settings, each with its time, and one colour bar.
    Image sheet(std::size_t count, const std::function<Frame(std::size_t)>& frame) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// One picture of one frame, as RenderSettings say. color_by: speed, depth, any scalar frame field, or a vector field's
/// magnitude. Throws InputError.
Image render(const Frame&, const Scene&, const RenderSettings&);

/// Written to a temporary file and renamed. Throws SimulationError.
void write_png(const std::filesystem::path&, const Image&);

}  // namespace grainray
