#include "render/strokes.hpp"

namespace grainray::picture {

void Stencil::print(Canvas& canvas, const Color& color, float strength) const {
    for (std::size_t i = 0; i < coverage_.size(); ++i)
        if (coverage_[i] > 0) canvas.color[i] = mix(canvas.color[i], color, strength * coverage_[i]);
}

void Writing::text(const std::string& words, float x, float y, float height, float align) {
    const Lettering lettering = letter(words);
    const float left = x - align * lettering.width * height, half_width = std::max(0.062f * height, 0.5f);
    for (const Stroke& s : lettering.strokes)
        line({left + s.x0 * height, y - s.y0 * height, left + s.x1 * height, y - s.y1 * height}, half_width);
}

void Writing::print(Canvas& canvas) const {
    const auto everywhere = [](int, int, float) { return true; };
    Stencil halo(canvas), front(canvas);
    for (const Inked& s : strokes_) {
        halo.add(s.stroke, s.half_width + 3.5f * unit_of(canvas), everywhere);
        front.add(s.stroke, s.half_width, everywhere);
    }
    halo.print(canvas, {1, 1, 1}, 0.8f);
    front.print(canvas, ink, 1);
}

}  // namespace grainray::picture
