// A picture from a frame: read render() as the table of contents of this folder.
#include "grainray/render.hpp"

#include <fmt/format.h>

#include "render/overlay.hpp"
#include "render/trace.hpp"

namespace grainray {

namespace {

void check_size(const char* key, std::int64_t pixels) {
    if (pixels < 16 || pixels > 16384) throw InputError(fmt::format("render.{} = {} must be 16 to 16384 pixels", key, pixels));
}

Image to_image(const picture::Canvas& canvas) {
    Image image{canvas.width, canvas.height, {}};
    image.rgb.reserve(3 * canvas.color.size());
    for (const picture::Color& c : canvas.color)
        for (int channel = 0; channel < 3; ++channel)
            image.rgb.push_back(static_cast<std::uint8_t>(std::clamp(c[channel], 0.f, 1.f) * 255 + 0.5f));
    return image;
}

}  // namespace

Image render(const Frame& frame, const Scene& scene, const RenderSettings& settings) {
    using namespace picture;
    check_size("width", settings.width);
    check_size("height", settings.height);
    const Vec3d up = settings.camera.up;
    const Subject subject = make_subject(frame, scene);
    const Paint paint = make_paint(frame, scene, settings, subject);
    const Room room = make_room(scene, subject, up, frame.time);
    const auto margins = margins_for(paint, static_cast<int>(settings.width), static_cast<int>(settings.height));
    const View view = make_view(settings, subject, room, margins);

    Canvas canvas = trace(view, subject, room, paint.colors, up);
    draw_outlines(canvas, view, room);
    draw_legend(canvas, paint);
    draw_caption(canvas, caption(frame.time, frame.size()));
    return to_image(canvas);
}

}  // namespace grainray
