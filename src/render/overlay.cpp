#include "render/overlay.hpp"

#include <fmt/format.h>

#include "render/palette.hpp"
#include "render/strokes.hpp"

namespace grainray::picture {

namespace {

/// Where a legend stands.
struct Place {
    float unit, size;           // of lengths and of letters
    float right, top, bottom;
    explicit Place(const Canvas& c)
        : unit(unit_of(c)), size(text_height(unit)), right(static_cast<float>(c.width) - 26 * unit),
          top(0.22f * static_cast<float>(c.height)), bottom(0.70f * static_cast<float>(c.height)) {}
    float title_line() const { return top - 1.9f * size; }
};

/// A filled rectangle; color_at(y) gives the colour of a row.
template <class ColorAt>
void fill(Canvas& canvas, float x0, float y0, float x1, float y1, const ColorAt& color_at) {
    for (int y = static_cast<int>(std::lround(y0)); y < static_cast<int>(std::lround(y1)); ++y)
        for (int x = static_cast<int>(std::lround(x0)); x < static_cast<int>(std::lround(x1)); ++x)
            canvas.blend(x, y, color_at(static_cast<float>(y) + 0.5f), 1);
}

/// A power of a thousand that the labels are divided by, so that they stay short.
int label_power(const Scale& scale) {
    const double largest = std::max(std::abs(scale.low), std::abs(scale.high));
    if (largest == 0 || (largest < 9999.5 && largest >= 0.01)) return 0;
    return 3 * static_cast<int>(std::floor(std::log10(largest) / 3 + 1e-9));
}

std::string bar_title(const Paint& paint, int power) {
    const std::string factor = power == 0 ? "" : fmt::format("10^{} ", power), unit = factor + paint.unit;
    return unit.empty() ? paint.title : fmt::format("{} ({})", paint.title, unit);
}

struct Mark {
    double value;
    std::string label;
};

std::vector<Mark> marks(const Scale& scale, int power) {
    const double step = tick_step(scale.low, scale.high), factor = std::pow(10.0, power);
    const int digits = std::max(0, -static_cast<int>(std::floor(std::log10(step / factor) + 1e-9)));
    std::vector<Mark> result;
    for (double k = std::ceil(scale.low / step - 1e-6); k * step <= scale.high + 1e-6 * step; ++k)
        result.push_back({k * step, fmt::format("{:.{}f}", k == 0 ? 0.0 : k * step / factor, digits)});
    return result;
}

/// A pointed end of the bar says that some values lie beyond; sign: -1 upwards.
void draw_tip(Canvas& canvas, float x0, float x1, float y, float sign, const Color& color) {
    const float middle = 0.5f * (x0 + x1), point = 0.5f * (x1 - x0);
    for (float d = 0.5f; d < point; ++d) {
        const float row = std::round(y) + sign * d, half = point - d;
        fill(canvas, middle - half, row - 0.5f, middle + half, row + 0.5f, [&](float) { return color; });
    }
}

void draw_bar(Canvas& canvas, const Paint& paint) {
    const Place at(canvas);
    const Scale& scale = *paint.scale;
    const float x1 = at.right - 4.2f * at.size, x0 = x1 - 18 * at.unit, height = at.bottom - at.top;
    const int power = label_power(scale);
    Writing writing;
    writing.text(bar_title(paint, power), at.right, at.title_line(), at.size, 1);
    for (const Mark& mark : marks(scale, power)) {
        const float y = at.bottom - height * static_cast<float>((mark.value - scale.low) / (scale.high - scale.low));
        writing.line({x1, y, x1 + 6 * at.unit, y}, std::max(0.6f * at.unit, 0.4f));
        writing.text(mark.label, x1 + 13 * at.unit, y + 0.5f * at.size, at.size);
    }
    writing.print(canvas);
    fill(canvas, x0, at.top, x1, at.bottom, [&](float y) { return scale_color((at.bottom - y) / height); });
    if (scale.above) draw_tip(canvas, x0, x1, at.top, -1, scale_color(1));
    if (scale.below) draw_tip(canvas, x0, x1, at.bottom, 1, scale_color(0));
}

float widest_name(const Paint& paint) {
    float widest = letter(paint.title).width - 2.1f;
    for (const Kind& kind : paint.kinds) widest = std::max(widest, letter(kind.name).width);
    return widest;
}

void draw_kinds(Canvas& canvas, const Paint& paint) {
    const Place at(canvas);
    const float text = at.right - widest_name(paint) * at.size, box = text - 2.1f * at.size;
    Writing writing;
    writing.text(paint.title, box, at.title_line(), at.size);
    float y = at.top;
    for (const Kind& kind : paint.kinds) {
        if (y > 0.9f * static_cast<float>(canvas.height)) break;
        fill(canvas, box, y, box + 1.3f * at.size, y + 1.3f * at.size, [&](float) { return kind.color; });
        writing.text(kind.name, text, y + 1.15f * at.size, at.size);
        y += 2.1f * at.size;
    }
    writing.print(canvas);
}

}  // namespace

bool has_text(int width, int height) { return width >= 240 && height >= 160; }

Margins margins_for(const Paint& paint, int width, int height) {
    if (!has_text(width, height)) return {};
    Margins margins{0.035, paint.scale ? 0.13 : 0.035, 0.06, 0.10};
    if (!paint.kinds.empty()) {
        const float wide = (widest_name(paint) + 3.5f) * text_height(unit_of(width, height)) / static_cast<float>(width);
        margins.right = std::min(0.35, 0.02 + static_cast<double>(wide));
    }
    return margins;
}

void draw_legend(Canvas& canvas, const Paint& paint) {
    if (!has_text(canvas.width, canvas.height)) return;
    if (paint.scale) draw_bar(canvas, paint);
    else if (!paint.kinds.empty()) draw_kinds(canvas, paint);
}

void draw_caption(Canvas& canvas, const std::string& text) {
    if (!has_text(canvas.width, canvas.height)) return;
    const float unit = unit_of(canvas), edge = 26 * unit;
    Writing writing;
    writing.text(text, edge, static_cast<float>(canvas.height) - edge, text_height(unit));
    writing.print(canvas);
}

namespace {

std::string with_commas(std::size_t number) {
    std::string count = std::to_string(number);
    for (std::ptrdiff_t i = static_cast<std::ptrdiff_t>(count.size()) - 3; i > 0; i -= 3)
        count.insert(static_cast<std::size_t>(i), 1, ',');
    return count;
}

}  // namespace

std::string caption(double time, std::size_t particles, std::size_t beyond) {
    const double size = std::abs(time);
    const std::string when = size >= 10 ? fmt::format("{:.1f}", time) : size >= 1 || size == 0 ? fmt::format("{:.2f}", time) : fmt::format("{:.3g}", time);
    const std::string all = fmt::format("t = {} s, {} particle{}", when, with_commas(particles), particles == 1 ? "" : "s");
    return beyond == 0 ? all : fmt::format("{} ({} beyond the ground shown)", all, with_commas(beyond));
}

}  // namespace grainray::picture
