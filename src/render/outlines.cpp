// Edges of planes over the traced picture.
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

}  // namespace

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
