// Edges of planes over the traced picture.
#include <array>

#include <fmt/format.h>

#include "render/overlay.hpp"
#include "render/strokes.hpp"

namespace grainray::picture {

namespace {

constexpr Color edge_color{0.45f, 0.47f, 0.50f};

/// Cuts the line just before the eye: behind it a projection would turn it around. False: nothing is left.
bool cut_before_eye(const View& view, Vec3d& p, Vec3d& q) {
    const double nearest = 1e-3 * length(view.eye) + 1e-12;
    const double zp = dot(p - view.eye, view.forward), zq = dot(q - view.eye, view.forward);
    if (zp < nearest && zq < nearest) return false;
    if (zp < nearest) p += (q - p) * ((nearest - zp) / (zq - zp));
    else if (zq < nearest) q += (p - q) * ((nearest - zq) / (zp - zq));
    return true;
}

/// The farthest depth about a pixel: an edge lies where depth jumps or is steep, so the pixel's own says too little.
double depth_about(const Canvas& canvas, int x, int y) {
    float farthest = 0;
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, canvas.height - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, canvas.width - 1); ++u) farthest = std::max(farthest, canvas.depth[canvas.at(u, v)]);
    return static_cast<double>(farthest);
}

void add_edge(Stencil& stencil, const Canvas& canvas, const View& view, Vec3d p, Vec3d q) {
    if (!cut_before_eye(view, p, q)) return;
    const Spot a = view.spot(p), b = view.spot(q);
    const Stroke s{static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(b.x), static_cast<float>(b.y)};
    stencil.add(s, std::max(0.6f * unit_of(canvas), 0.35f), [&](int x, int y, float t) {
        const double depth = 1 / ((1 - t) / a.depth + t / b.depth);  // along a line in the image 1/depth grows evenly
        return depth < 1.002 * depth_about(canvas, x, y);
    });
}

/// Floors fade where the room is open: no edge there.
bool fades(const Room& room, const Panel& panel, const Vec3d& p, const Vec3d& q) {
    if (!panel.floor) return false;
    const double tolerance = 1e-4 * length(room.box.extent());
    for (int axis = 0; axis < 3; ++axis) {
        if (room.open_below[axis] && std::max(p[axis], q[axis]) < room.box.lower[axis] + tolerance) return true;
        if (room.open_above[axis] && std::min(p[axis], q[axis]) > room.box.upper[axis] - tolerance) return true;
    }
    return false;
}

/// The part of an edge that is not cut away; false: there is none.
bool cut_edge(const std::optional<Cut>& cut, Vec3d& p, Vec3d& q) {
    if (!cut) return true;
    const auto beyond = [&](const Vec3d& v) { return dot(v - convert<double>(cut->point), convert<double>(cut->normal)); };
    const double a = beyond(p), b = beyond(q);
    if (a > 0 && b > 0) return false;
    if (a > 0) p += (q - p) * (a / (a - b));
    else if (b > 0) q += (p - q) * (b / (b - a));
    return true;
}

/// The lower edge of the block whose middle is nearest to the eye, from left to right in the picture.
std::array<Vec3d, 2> near_edge(const View& view, const Box& box) {
    const Vec3d low = box.lower, high = box.upper;
    const Vec3d corners[4] = {{low.x, low.y, low.z}, {high.x, low.y, low.z}, {high.x, high.y, low.z}, {low.x, high.y, low.z}};
    std::array<Vec3d, 2> best{};
    for (int k = 0; k < 4; ++k) {
        const Vec3d &p = corners[k], &q = corners[(k + 1) % 4];
        // Seen across, not along: a length in the picture, not in the distance.
        const auto length_seen = [&](const Vec3d& a, const Vec3d& b) { return std::abs(dot(b - a, view.right)) / length((a + b) * 0.5 - view.eye); };
        const bool in_front = length((p + q) * 0.5 - view.eye) < length((low + Vec3d{high.x, high.y, low.z}) * 0.5 - view.eye);
        if (in_front && (best[0] == best[1] || length_seen(p, q) > length_seen(best[0], best[1]))) best = {p, q};
    }
    if (dot(best[1] - best[0], view.right) < 0) std::swap(best[0], best[1]);
    return best;
}

}  // namespace

void draw_scale_bar(Canvas& canvas, const View& view, const Relief& relief, float unit) {
    if (!has_text(canvas.width, canvas.height)) return;
    auto [p, q] = near_edge(view, relief.box);
    const double whole = length(q - p), size = tick_step(0, whole);  // a sixth of the edge or more
    if (!(whole > 0)) return;
    const Vec3d along = (q - p) * (1 / whole), middle = (relief.box.lower + relief.box.upper) * 0.5;
    Vec3d outwards = cross(along, Vec3d{0, 0, 1});
    if (dot(outwards, p - middle) < 0) outwards = -outwards;
    const Vec3d start = p + along * (0.03 * whole) + outwards * (0.025 * whole);
    const Spot a = view.spot(start), b = view.spot(start + along * size);
    if (a.depth <= 0 || b.depth <= 0) return;
    const auto pixel = [](double v) { return static_cast<float>(v); };
    const float text = text_height(unit), tip = 5 * unit;
    Writing writing;
    const float half = std::max(1.1f * unit, 0.6f);
    writing.line({pixel(a.x), pixel(a.y), pixel(b.x), pixel(b.y)}, half);
    for (const Spot& end : {a, b}) writing.line({pixel(end.x), pixel(end.y) - tip, pixel(end.x), pixel(end.y) + tip}, half);
    const std::string label = size >= 1000 ? fmt::format("{:g} km", size / 1000) : fmt::format("{:g} m", size);
    writing.text(label, pixel(0.5 * (a.x + b.x)) - 0.5f * letter(label).width * text, pixel(std::max(a.y, b.y)) + 1.9f * text, text);
    writing.print(canvas);
}

void draw_edges(Canvas& canvas, const View& view, const std::vector<Skin>& meshes, const std::optional<Cut>& cut) {
    Stencil stencil(canvas);
    for (const Skin& mesh : meshes)
        for (const auto& [from, to] : mesh.edges)
            if (Vec3d p = convert<double>(from), q = convert<double>(to); cut_edge(cut, p, q)) add_edge(stencil, canvas, view, p, q);
    stencil.print(canvas, edge_color, 0.45f);
}

void draw_outlines(Canvas& canvas, const View& view, const Room& room) {
    Stencil faces(canvas), glass(canvas);
    for (const Panel& panel : room.panels)
        for (std::size_t i = 0; i < panel.outline.size(); ++i) {
            const Vec3d &p = panel.outline[i], &q = panel.outline[(i + 1) % panel.outline.size()];
            if (!fades(room, panel, p, q)) add_edge(panel.shows_face(view.eye) ? faces : glass, canvas, view, p, q);
        }
    glass.print(canvas, edge_color, 0.35f);
    faces.print(canvas, edge_color, 0.5f);
}

}  // namespace grainray::picture
