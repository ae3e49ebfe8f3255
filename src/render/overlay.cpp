#include "render/overlay.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "render/glyphs.hpp"
#include "render/palette.hpp"

namespace grainray::picture {

namespace {

constexpr Color ink{0.13f, 0.14f, 0.16f}, line_ink{0.45f, 0.47f, 0.50f};

/// Sizes are meant for 1280 x 720 and follow the image.
float unit_of(const Canvas& c) { return std::min(static_cast<float>(c.width) / 1280, static_cast<float>(c.height) / 720); }
float text_height(const Canvas& c) { return std::max(15 * unit_of(c), 7.f); }

float distance_to(const Stroke& s, float x, float y) {
    const float dx = s.x1 - s.x0, dy = s.y1 - s.y0, length2 = dx * dx + dy * dy;
    const float t = length2 > 0 ? std::clamp(((x - s.x0) * dx + (y - s.y0) * dy) / length2, 0.f, 1.f) : 0.f;
    return std::hypot(x - s.x0 - t * dx, y - s.y0 - t * dy);
}

/// Calls set(x, y, coverage) for the pixels of the canvas that the stroke of that half width touches.
template <class Set>
void cover(const Canvas& canvas, const Stroke& s, float half_width, const Set& set) {
    const float reach = half_width + 1;
    const int x0 = std::max(0, static_cast<int>(std::min(s.x0, s.x1) - reach)), x1 = std::min(canvas.width - 1, static_cast<int>(std::max(s.x0, s.x1) + reach));
    const int y0 = std::max(0, static_cast<int>(std::min(s.y0, s.y1) - reach)), y1 = std::min(canvas.height - 1, static_cast<int>(std::max(s.y0, s.y1) + reach));
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
            const float c = half_width + 0.5f - distance_to(s, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            if (c > 0) set(x, y, std::min(c, 1.f));
        }
}

/// Where strokes meet the pixel takes the stronger one, not both: gathered first, inked once.
class Stencil {
public:
    explicit Stencil(Canvas& canvas) : canvas_(canvas), coverage_(canvas.color.size(), 0.f) {}
    void add(const Stroke& s, float half_width) {
        cover(canvas_, s, half_width, [&](int x, int y, float c) { set(x, y, c); });
    }
    void set(int x, int y, float c) { coverage_[canvas_.at(x, y)] = std::max(coverage_[canvas_.at(x, y)], c); }
    void ink(const Color& color, float strength) {
        for (std::size_t i = 0; i < coverage_.size(); ++i)
            if (coverage_[i] > 0) canvas_.color[i] = mix(canvas_.color[i], color, strength * coverage_[i]);
    }

private:
    Canvas& canvas_;
    std::vector<float> coverage_;
};

/// (x, y): left end of the baseline, or with `align` = 1 the right end, 0.5 the middle.
void add_text(Stencil& stencil, const std::string& text, float x, float y, float height, float align) {
    const Lettering line = letter(text);
    const float left = x - align * line.width * height;
    for (const Stroke& s : line.strokes)
        stencil.add({left + s.x0 * height, y - s.y0 * height, left + s.x1 * height, y - s.y1 * height}, std::max(0.062f * height, 0.5f));
}

void fill(Canvas& canvas, float x0, float y0, float x1, float y1, const auto& color_at) {
    for (int y = static_cast<int>(std::lround(y0)); y < static_cast<int>(std::lround(y1)); ++y)
        for (int x = static_cast<int>(std::lround(x0)); x < static_cast<int>(std::lround(x1)); ++x)
            canvas.blend(x, y, color_at(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f), 1);
}

/// Makes the ground behind a legend pale, from `left` to the image's edge: a lone particle may lie there.
void whiten(Canvas& canvas, float left, float top, float bottom) {
    for (int y = static_cast<int>(top); y < static_cast<int>(bottom); ++y)
        for (int x = static_cast<int>(left); x < canvas.width; ++x) canvas.blend(x, y, {1, 1, 1}, 0.8f);
}

/// A power of a thousand that the labels are divided by, so that they stay short.
int label_power(const Scale& scale) {
    const double largest = std::max(std::abs(scale.low), std::abs(scale.high));
    if (largest == 0 || (largest < 9999.5 && largest >= 0.01)) return 0;
    return 3 * static_cast<int>(std::floor(std::log10(largest) / 3));
}

std::string bar_title(const Paint& paint, int power) {
    if (power == 0) return paint.unit.empty() ? paint.title : fmt::format("{} ({})", paint.title, paint.unit);
    return paint.unit.empty() ? fmt::format("{} (10^{} )", paint.title, power) : fmt::format("{} (10^{} {})", paint.title, power, paint.unit);
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

void draw_bar(Canvas& canvas, const Paint& paint) {
    const Scale& scale = *paint.scale;
    const float u = unit_of(canvas), size = text_height(canvas), right = static_cast<float>(canvas.width) - 26 * u;
    const float x1 = right - 4.2f * size, x0 = x1 - 18 * u;
    const float top = 0.22f * static_cast<float>(canvas.height), bottom = 0.70f * static_cast<float>(canvas.height);
    const int power = label_power(scale);
    const std::string title = bar_title(paint, power);
    whiten(canvas, std::min(x0, right - letter(title).width * size) - size, top - 3.8f * size, bottom + 2 * size);
    fill(canvas, x0, top, x1, bottom, [&](float, float y) { return scale_color((bottom - y) / (bottom - top)); });

    Stencil stencil(canvas);
    const float half = std::max(0.6f * u, 0.4f);
    add_text(stencil, title, right, top - 1.9f * size, size, 1);
    for (const Mark& mark : marks(scale, power)) {
        const float y = bottom - (bottom - top) * static_cast<float>((mark.value - scale.low) / (scale.high - scale.low));
        stencil.add({x1, y, x1 + 6 * u, y}, half);
        add_text(stencil, mark.label, x1 + 13 * u, y + 0.5f * size, size, 0);
    }
    stencil.ink(ink, 1);
    // Pointed ends say that some values lie beyond.
    const float middle = 0.5f * (x0 + x1), point = 0.5f * (x1 - x0);
    const auto arrow = [&](float y, float sign, float t) {
        for (float d = 0.5f; d < point; ++d)
            fill(canvas, middle - (point - d), y + sign * d - 0.5f, middle + (point - d), y + sign * d + 0.5f, [&](float, float) { return scale_color(t); });
    };
    if (scale.above) arrow(std::round(top) , -1, 1);
    if (scale.below) arrow(std::round(bottom), 1, 0);
}

void draw_kinds(Canvas& canvas, const Paint& paint) {
    const float u = unit_of(canvas), size = text_height(canvas), right = static_cast<float>(canvas.width) - 26 * u;
    float widest = 0;
    for (const Kind& kind : paint.kinds) widest = std::max(widest, letter(kind.name).width);
    const float text = right - widest * size, box = text - 2.1f * size;
    Stencil stencil(canvas);
    float y = 0.22f * static_cast<float>(canvas.height);
    whiten(canvas, std::min(box, right - letter(paint.title).width * size) - size, y - 3.8f * size,
           std::min(y + 2.1f * size * static_cast<float>(paint.kinds.size()) + size, 0.97f * static_cast<float>(canvas.height)));
    add_text(stencil, paint.title, right, y - 1.9f * size, size, 1);
    for (const Kind& kind : paint.kinds) {
        if (y > 0.9f * static_cast<float>(canvas.height)) break;
        fill(canvas, box, y, box + 1.3f * size, y + 1.3f * size, [&](float, float) { return kind.color; });
        add_text(stencil, kind.name, text, y + 1.15f * size, size, 0);
        y += 2.1f * size;
    }
    stencil.ink(ink, 1);
}

constexpr double near = 1e-3;  // of the subject's distance: lines are cut there, before they turn around behind the eye

void add_edge(Stencil& stencil, const Canvas& canvas, const View& view, Vec3d p, Vec3d q, float half_width) {
    const double cut = near * length(view.eye) + 1e-12;
    double zp = dot(p - view.eye, view.forward), zq = dot(q - view.eye, view.forward);
    if (zp < cut && zq < cut) return;
    if (zp < cut) p = p + (q - p) * ((cut - zp) / (zq - zp));
    else if (zq < cut) q = q + (p - q) * ((cut - zq) / (zp - zq));
    const Spot a = view.spot(p), b = view.spot(q);
    const Stroke s{static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(b.x), static_cast<float>(b.y)};
    const float dx = s.x1 - s.x0, dy = s.y1 - s.y0, length2 = std::max(dx * dx + dy * dy, 1e-12f);
    cover(canvas, s, half_width, [&](int x, int y, float c) {
        const float t = std::clamp(((static_cast<float>(x) + 0.5f - s.x0) * dx + (static_cast<float>(y) + 0.5f - s.y0) * dy) / length2, 0.f, 1.f);
        const double depth = 1 / ((1 - t) / a.depth + t / b.depth);  // along a line in the image 1/depth is what grows evenly
        if (depth < canvas.depth[canvas.at(x, y)] * 1.002) stencil.set(x, y, c);
    });
}

/// Floors fade where the room is open: no edge there.
bool fades(const Room& room, const Panel& panel, const Vec3d& p, const Vec3d& q) {
    if (!panel.floor) return false;
    const double near_by = 1e-4 * length(room.box.extent());
    for (int axis = 0; axis < 3; ++axis) {
        if (room.open_below[axis] && std::max(p[axis], q[axis]) < room.box.lower[axis] + near_by) return true;
        if (room.open_above[axis] && std::min(p[axis], q[axis]) > room.box.upper[axis] - near_by) return true;
    }
    return false;
}

}  // namespace

bool has_text(int width, int height) { return width >= 240 && height >= 160; }

Margins margins_for(const Paint& paint, int width, int height) {
    if (!has_text(width, height)) return {};
    const bool legend = paint.scale || !paint.kinds.empty();
    return {0.035, legend ? 0.13 : 0.035, 0.06, 0.10};
}

void draw_outlines(Canvas& canvas, const View& view, const Room& room) {
    Stencil faces(canvas), hidden(canvas);
    const float half_width = std::max(0.6f * unit_of(canvas), 0.35f);
    for (const Panel& panel : room.panels) {
        const bool face = panel.shows_face(view.eye);
        for (std::size_t i = 0; i < panel.outline.size(); ++i) {
            const Vec3d &p = panel.outline[i], &q = panel.outline[(i + 1) % panel.outline.size()];
            if (!fades(room, panel, p, q)) add_edge(face ? faces : hidden, canvas, view, p, q, half_width);
        }
    }
    hidden.ink(line_ink, 0.35f);
    faces.ink(line_ink, 0.5f);
}

void draw_legend(Canvas& canvas, const Paint& paint) {
    if (!has_text(canvas.width, canvas.height)) return;
    if (paint.scale) draw_bar(canvas, paint);
    else if (!paint.kinds.empty()) draw_kinds(canvas, paint);
}

void draw_caption(Canvas& canvas, const std::string& text) {
    if (!has_text(canvas.width, canvas.height)) return;
    Stencil stencil(canvas);
    const float u = unit_of(canvas);
    add_text(stencil, text, 26 * u, static_cast<float>(canvas.height) - 26 * u, text_height(canvas), 0);
    stencil.ink(ink, 1);
}

std::string caption(double time, std::size_t particles) {
    std::string count = std::to_string(particles);
    for (std::ptrdiff_t i = static_cast<std::ptrdiff_t>(count.size()) - 3; i > 0; i -= 3) count.insert(static_cast<std::size_t>(i), 1, ',');
    const std::string when = std::abs(time) >= 10 ? fmt::format("{:.1f}", time) : std::abs(time) >= 1 || time == 0 ? fmt::format("{:.2f}", time) : fmt::format("{:.3g}", time);
    return fmt::format("t = {} s, {} particle{}", when, count, particles == 1 ? "" : "s");
}

}  // namespace grainray::picture
