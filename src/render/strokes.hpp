// Anti-aliased strokes on a canvas: text and lines.
#pragma once

#include <string>
#include <vector>

#include "render/canvas.hpp"
#include "render/glyphs.hpp"

namespace grainray::picture {

inline constexpr Color ink{0.13f, 0.14f, 0.16f};

/// Sizes are meant for 1280 x 720 and follow the image.
inline float unit_of(int width, int height) { return std::min(static_cast<float>(width) / 1280, static_cast<float>(height) / 720); }
inline float unit_of(const Canvas& c) { return unit_of(c.width, c.height); }
inline float text_height(float unit) { return std::max(15 * unit, 7.f); }

/// How far along the stroke, from 0 to 1, the point nearest to (x, y) is.
inline float along(const Stroke& s, float x, float y) {
    const float dx = s.x1 - s.x0, dy = s.y1 - s.y0, length2 = dx * dx + dy * dy;
    return length2 > 0 ? std::clamp(((x - s.x0) * dx + (y - s.y0) * dy) / length2, 0.f, 1.f) : 0.f;
}

/// Shares of pixels that are covered. Where strokes meet a pixel takes the stronger one, not both: gathered first, inked once.
class Stencil {
public:
    explicit Stencil(const Canvas& canvas) : width_(canvas.width), height_(canvas.height), coverage_(canvas.color.size(), 0.f) {}

    /// Strokes in pixels; `visible(x, y, t)` may leave pixels out, t says where on the stroke they are.
    template <class Visible>
    void add(const Stroke& s, float half_width, const Visible& visible) {
        const float reach = half_width + 1;
        const int x0 = first(std::min(s.x0, s.x1) - reach), x1 = last(std::max(s.x0, s.x1) + reach, width_);
        const int y0 = first(std::min(s.y0, s.y1) - reach), y1 = last(std::max(s.y0, s.y1) + reach, height_);
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) {
                const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f, t = along(s, px, py);
                const float distance = std::hypot(px - s.x0 - t * (s.x1 - s.x0), py - s.y0 - t * (s.y1 - s.y0));
                const float c = std::min(half_width + 0.5f - distance, 1.f);
                float& here = coverage_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
                if (c > here && visible(x, y, t)) here = c;
            }
    }
    void print(Canvas&, const Color&, float strength) const;

private:
    static int first(float at) { return static_cast<int>(std::clamp(at, 0.f, 1e6f)); }
    static int last(float at, int size) { return static_cast<int>(std::clamp(at, -1.f, static_cast<float>(size - 1))); }
    int width_, height_;
    std::vector<float> coverage_;
};

/// Lettering and marks of one colour; on print they get a white halo, so that they can be read on anything.
class Writing {
public:
    void line(const Stroke& s, float half_width) { strokes_.push_back({s, half_width}); }
    /// (x, y): left end of the baseline, or with `align` = 1 the right end.
    void text(const std::string&, float x, float y, float height, float align = 0);
    void print(Canvas&) const;

private:
    struct Inked {
        Stroke stroke;
        float half_width;
    };
    std::vector<Inked> strokes_;
};

}  // namespace grainray::picture
