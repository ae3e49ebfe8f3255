#include "render/trace.hpp"

#include <numbers>

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include "render/ray_scene.hpp"

namespace grainray::picture {

namespace {

constexpr int grid = 4;            // samples a pixel: a grid of 4 x 4, each jittered within its cell
constexpr int sky_rays = 3;        // a sample
constexpr float lamp_size = 0.08f;  // tangent of its angular radius: the softness of shadows
constexpr Color background{1, 1, 1}, floor_color{0.86f, 0.86f, 0.86f}, wall_color{0.80f, 0.81f, 0.83f};

/// Two numbers in [0, 1), evenly spread over successive k (the R2 sequence), shifted by the pixel's own hash.
struct Pair { float u, v; };
class Noise {
public:
    explicit Noise(std::uint32_t seed) : u_(hash(seed)), v_(hash(seed ^ 0x9e3779b9u)) {}
    Pair operator()(std::uint32_t k) const { return {unit_from_bits(u_ + k * 3242174889u), unit_from_bits(v_ + k * 2447445414u)}; }

private:
    std::uint32_t u_, v_;
};

/// Two unit vectors that are perpendicular to n and to each other.
struct Tangents {
    Vec3f a, b;
    explicit Tangents(const Vec3f& n) : a(normalized(cross(n, std::abs(n.x) < 0.6f ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0}))), b(cross(n, a)) {}
};

/// Within the hemisphere about n, as often as a matte surface looks there.
Vec3f matte_direction(const Vec3f& n, const Pair& p) {
    const Tangents t(n);
    const float angle = 2 * std::numbers::pi_v<float> * p.u, radius = std::sqrt(p.v);
    return t.a * (radius * std::cos(angle)) + t.b * (radius * std::sin(angle)) + n * std::sqrt(1 - p.v);
}

/// A panel as rays see it: edges are half-planes with inward normals.
struct Facet {
    Vec3f point, normal;
    std::vector<Vec3f> corners, inward;
    bool floor;

    explicit Facet(const Panel& panel) : point(convert<float>(panel.surface[0])), normal(convert<float>(panel.normal)), floor(panel.floor) {
        const std::size_t n = panel.surface.size();
        for (std::size_t i = 0; i < n; ++i) {
            corners.push_back(convert<float>(panel.surface[i]));
            inward.push_back(convert<float>(cross(panel.normal, panel.surface[(i + 1) % n] - panel.surface[i])));
        }
    }
    /// Distance along the ray, or infinity.
    float meet(const Ray& ray) const {
        constexpr float never = std::numeric_limits<float>::infinity();
        const float along = dot(ray.direction, normal);
        const float t = dot(point - ray.origin, normal) / along;
        if (!(along < 0 && t > 0)) return never;
        const Vec3f p = ray.origin + ray.direction * t;
        for (std::size_t i = 0; i < corners.size(); ++i)
            if (dot(p - corners[i], inward[i]) < 0) return never;
        return t;
    }
};

struct Surface {
    Vec3f at, normal;
    Color color;
    float lift;     // how far to step off it before looking around
    float wrap;     // 0: lit as matte surfaces are; 1: lamplight reaches round, so that no panel is dark
    float gloss;
};

struct Sample {
    Color light;
    float depth;
};

class Tracer {
public:
    Tracer(const View& view, const Subject& subject, const Room& room, const std::vector<Color>& colors, const Vec3d& up)
        : view_(view), subject_(subject), room_(room), colors_(colors), up_(convert<float>(normalized(up))), rays_(subject.spheres),
          facet_lift_(static_cast<float>(1e-5 * subject.diagonal())) {
        for (const Panel& panel : room.panels)
            if (panel.shows_face(view.eye)) facets_.emplace_back(panel);
        // From behind the viewer's left shoulder: the lit sides are seen, shadows fall away to the right.
        const Vec3f right = convert<float>(view.right), ahead = cross(up_, right);
        lamp_ = normalized(up_ * 0.85f - right * 0.5f - ahead * 0.42f);
    }

    void pixel(Canvas& canvas, int x, int y) const {
        const Noise noise(hash(static_cast<std::uint32_t>(x)) + static_cast<std::uint32_t>(y));
        const Noise jitter(hash(static_cast<std::uint32_t>(y)) ^ static_cast<std::uint32_t>(x));
        Color sum;
        float depth = std::numeric_limits<float>::infinity();
        for (int s = 0; s < grid * grid; ++s) {
            const Pair j = jitter(static_cast<std::uint32_t>(s));
            const Ray ray = view_.ray(x + (s % grid + j.u) / grid, y + (s / grid + j.v) / grid);
            const Sample sample = look(ray, noise, static_cast<std::uint32_t>(s));
            // Mixed as displayed, not as light: bright edges on white would eat the thin dark gaps otherwise.
            sum += display_from_linear(sample.light);
            depth = std::min(depth, sample.depth);
        }
        canvas.color[canvas.at(x, y)] = sum * (1.f / (grid * grid));
        canvas.depth[canvas.at(x, y)] = depth;
    }

private:
    Sample look(const Ray& ray, const Noise& noise, std::uint32_t s) const {
        const auto hit = rays_.first(ray);
        float distance = hit ? hit->distance : std::numeric_limits<float>::infinity();
        const Facet* nearest = nullptr;
        for (const Facet& facet : facets_)
            if (const float t = facet.meet(ray); t < distance) distance = t, nearest = &facet;
        if (!nearest && !hit) return {background, distance};

        const Vec3f at = ray.origin + ray.direction * distance;
        const float depth = distance * dot(ray.direction, convert<float>(view_.forward));
        if (!nearest) return {shade(sphere(at, hit->sphere), ray, noise, s), depth};
        const float presence = nearest->floor ? floor_presence(room_, at) : 1;
        if (presence <= 0) return {background, depth};
        const Color color = nearest->floor ? floor_color : wall_color;
        return {mix(background, shade({at, nearest->normal, color, facet_lift_, 1, 0}, ray, noise, s), presence), depth};
    }

    Surface sphere(const Vec3f& at, std::uint32_t k) const {
        const Sphere& s = subject_.spheres[k];
        const Vec3f n = normalized(at - s.centre);
        return {s.centre + n * s.radius, n, colors_[k], 1e-3f * s.radius, 0, 0.12f};
    }

    Color shade(const Surface& s, const Ray& ray, const Noise& noise, std::uint32_t sample) const {
        const Vec3f from = s.at + s.normal * s.lift;
        Color light = sky(s, from, noise, sample);
        float shine = 0;
        const float facing = std::max(dot(s.normal, lamp_) * (1 - 0.5f * s.wrap) + 0.5f * s.wrap, 0.f);
        if (facing > 0 && !rays_.blocked({from, towards_lamp(noise, sample)})) {
            light += Color{0.62f, 0.61f, 0.59f} * facing;
            const float mirror = dot(s.normal, normalized(lamp_ - ray.direction));
            shine = s.gloss * std::pow(std::max(mirror, 0.f), 40.f);
        }
        return times(s.color, light) + Color{shine, shine, shine};
    }

    /// Light from the open sky, less from below; what spheres hide sends back some of the surface's own colour.
    Color sky(const Surface& s, const Vec3f& from, const Noise& noise, std::uint32_t sample) const {
        Color light;
        for (std::uint32_t k = 0; k < sky_rays; ++k) {
            const Vec3f d = matte_direction(s.normal, noise(sample * sky_rays + k));
            if (rays_.blocked({from, d})) light += s.color * 0.12f;
            else light += Color{0.60f, 0.61f, 0.63f} * (0.78f + 0.22f * dot(d, up_));
        }
        return light * (1.f / sky_rays);
    }

    Vec3f towards_lamp(const Noise& noise, std::uint32_t sample) const {
        const Tangents t(lamp_);
        const Pair p = noise(sample + 101);
        const float angle = 2 * std::numbers::pi_v<float> * p.u, radius = lamp_size * std::sqrt(p.v);
        return normalized(lamp_ + t.a * (radius * std::cos(angle)) + t.b * (radius * std::sin(angle)));
    }

    const View& view_;
    const Subject& subject_;
    const Room& room_;
    const std::vector<Color>& colors_;
    Vec3f up_, lamp_;
    RayScene rays_;
    std::vector<Facet> facets_;
    float facet_lift_;
};

}  // namespace

Canvas trace(const View& view, const Subject& subject, const Room& room, const std::vector<Color>& colors, const Vec3d& up) {
    const Tracer tracer(view, subject, room, colors, up);
    Canvas canvas(view.width, view.height, background);
    tbb::parallel_for(tbb::blocked_range2d<int>(0, view.height, 16, 0, view.width, 16), [&](const auto& tile) {
        for (int y = tile.rows().begin(); y < tile.rows().end(); ++y)
            for (int x = tile.cols().begin(); x < tile.cols().end(); ++x) tracer.pixel(canvas, x, y);
    });
    return canvas;
}

}  // namespace grainray::picture
