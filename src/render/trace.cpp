#include "render/trace.hpp"

#include <numbers>

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include "render/directions.hpp"
#include "render/ray_scene.hpp"

namespace grainray::picture {

namespace {

constexpr int grid = 4;            // samples a pixel: a grid of 4 x 4, each jittered within its cell
constexpr int sky_rays = 3;        // a sample
constexpr float lamp_size = 0.08f;  // tangent of its angular radius: the softness of shadows
constexpr Color background{1, 1, 1}, floor_color{0.86f, 0.86f, 0.86f}, wall_color{0.80f, 0.81f, 0.83f}, steel{0.56f, 0.59f, 0.63f};
constexpr int most_layers = 16;     // of meshes one behind the other
constexpr float never = std::numeric_limits<float>::infinity();

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
    explicit Tracer(const Stage& stage)
        : stage_(stage), up_(convert<float>(normalized(stage.up))), rays_(stage.subject.spheres, ground(stage)), meshes_({}, pointers(stage.meshes)),
          panel_lift_(static_cast<float>(1e-5 * stage.subject.diagonal())),
          skin_lift_(10 * panel_lift_ + static_cast<float>(1e-5 * length(stage.view.eye))) {
        for (const Panel& panel : stage.room.panels)
            if (panel.shows_face(stage.view.eye)) facets_.emplace_back(panel);
        // From behind the viewer's left shoulder: the lit sides are seen, shadows fall away to the right. Over terrain
        // from the left: slopes show their form.
        const Vec3f right = convert<float>(stage.view.right), ahead = cross(up_, right);
        lamp_ = normalized(stage.relief ? up_ * 0.75f - right * 0.8f - ahead * 0.1f : up_ * 0.85f - right * 0.5f - ahead * 0.42f);
    }

    void pixel(Canvas& canvas, int x, int y) const {
        const Noise noise(hash(static_cast<std::uint32_t>(x)) + static_cast<std::uint32_t>(y));
        const Noise jitter(hash(static_cast<std::uint32_t>(y)) ^ static_cast<std::uint32_t>(x));
        Color sum;
        float depth = never;
        for (int s = 0; s < grid * grid; ++s) {
            const Pair j = jitter(static_cast<std::uint32_t>(s));
            const Ray ray = stage_.view.ray(x + (s % grid + j.u) / grid, y + (s / grid + j.v) / grid);
            const Sample sample = look(ray, noise, static_cast<std::uint32_t>(s));
            // Mixed as displayed, not as light: bright edges on white would eat the thin dark gaps otherwise.
            sum += display_from_linear(sample.light);
            depth = std::min(depth, sample.depth);
        }
        canvas.color[canvas.at(x, y)] = sum * (1.f / (grid * grid));
        canvas.depth[canvas.at(x, y)] = depth;
    }

private:
    static std::vector<const Skin*> ground(const Stage& stage) {
        return stage.relief ? std::vector<const Skin*>{&stage.relief->surface, &stage.relief->sides} : std::vector<const Skin*>{};
    }
    static std::vector<const Skin*> pointers(const std::vector<Skin>& skins) {
        std::vector<const Skin*> result;
        for (const Skin& skin : skins) result.push_back(&skin);
        return result;
    }

    /// What is solid, seen through the meshes before it.
    Sample look(const Ray& ray, const Noise& noise, std::uint32_t s) const {
        Sample solid = look_at_solid(ray, noise, s);
        if (meshes_.empty()) return solid;
        Color light;
        float clear = 1;
        const float to_depth = dot(ray.direction, convert<float>(stage_.view.forward));
        each_layer(ray, [&](const RayScene::Hit& hit, const Vec3f& at) {
            if (hit.distance * to_depth >= solid.depth) return false;
            const Surface surface = mesh(ray, at, hit);
            const float edge_on = 1 - std::abs(dot(surface.normal, ray.direction)), opacity = mix_opacity(edge_on);
            light += shade(surface, ray, noise, s) * (clear * opacity);
            clear *= 1 - opacity;
            if (clear < 1e-3f) solid.depth = hit.distance * to_depth;
            return clear >= 1e-3f;
        });
        return {light + solid.light * clear, solid.depth};
    }

    /// A sheet hides more where it is seen along its face, as glass does.
    float mix_opacity(float edge_on) const { return stage_.mesh_opacity + (1 - stage_.mesh_opacity) * 0.6f * edge_on * edge_on * edge_on; }

    /// visit(hit, place) for the parts of meshes along a ray that are not cut away, until it returns false.
    template <class Visit>
    void each_layer(const Ray& ray, const Visit& visit) const {
        float from = 0;
        for (int layer = 0; layer < most_layers; ++layer) {
            const auto hit = meshes_.first(ray, from);
            if (!hit) return;
            const Vec3f at = ray.origin + ray.direction * hit->distance;
            const bool there = !stage_.cut || dot(at - stage_.cut->point, stage_.cut->normal) <= 0;
            if (there && !visit(*hit, at)) return;
            from = hit->distance + std::max(panel_lift_, hit->distance * 1e-6f);
        }
    }

    Sample look_at_solid(const Ray& ray, const Noise& noise, std::uint32_t s) const {
        const auto hit = rays_.first(ray);
        float distance = hit ? hit->distance : never;
        const Facet* nearest = nullptr;
        for (const Facet& facet : facets_)
            if (const float t = facet.meet(ray); t < distance) distance = t, nearest = &facet;
        if (!nearest && !hit) return {background, distance};

        const Vec3f at = ray.origin + ray.direction * distance;
        const float depth = distance * dot(ray.direction, convert<float>(stage_.view.forward));
        if (!nearest) return {shade(hit->part == 0 ? sphere(at, hit->primitive) : terrain(ray, at, *hit), ray, noise, s), depth};
        const float presence = nearest->floor ? floor_presence(stage_.room, at) : 1;
        if (presence <= 0) return {background, depth};
        const Color color = nearest->floor ? floor_color : wall_color;
        return {mix(background, shade({at, nearest->normal, color, panel_lift_, 1, 0}, ray, noise, s), presence), depth};
    }

    Surface sphere(const Vec3f& at, std::uint32_t k) const {
        const Sphere& s = stage_.subject.spheres[k];
        const Vec3f n = normalized(at - s.centre);
        return {s.centre + n * s.radius, n, stage_.colors[k], 1e-3f * s.radius, 0, 0.12f};
    }

    Surface terrain(const Ray& ray, const Vec3f& at, const RayScene::Hit& hit) const {
        const bool surface = hit.part == 1;
        const Skin& skin = surface ? stage_.relief->surface : stage_.relief->sides;
        const Vec3f n = skin.normal(hit.primitive, hit.u, hit.v, ray.direction);
        const Color color = surface ? stage_.relief->color(at, n) : stage_.relief->side_color(at);
        return {at, n, color, skin_lift_, surface ? 0.25f : 0.6f, 0};
    }

    Surface mesh(const Ray& ray, const Vec3f& at, const RayScene::Hit& hit) const {
        const Vec3f n = stage_.meshes[hit.part - 1].normal(hit.primitive, hit.u, hit.v, ray.direction);
        return {at, n, steel, skin_lift_, 0.5f, 0.25f};
    }

    /// The share of light that comes along a ray, through meshes too.
    float open(const Ray& ray) const {
        if (rays_.blocked(ray)) return 0;
        float clear = 1;
        if (!meshes_.empty())
            each_layer(ray, [&](const RayScene::Hit&, const Vec3f&) {
                clear *= 1 - stage_.mesh_opacity;
                return clear > 0;
            });
        return clear;
    }

    Color shade(const Surface& s, const Ray& ray, const Noise& noise, std::uint32_t sample) const {
        const Vec3f from = s.at + s.normal * s.lift;
        Color light = sky(s, from, noise, sample);
        float shine = 0;
        const float facing = std::max(dot(s.normal, lamp_) * (1 - 0.5f * s.wrap) + 0.5f * s.wrap, 0.f);
        const float lit = facing > 0 ? open({from, towards_lamp(noise, sample)}) : 0;
        if (lit > 0) {
            light += Color{0.62f, 0.61f, 0.59f} * (lit * facing);
            const float mirror = dot(s.normal, normalized(lamp_ - ray.direction));
            shine = lit * s.gloss * std::pow(std::max(mirror, 0.f), 40.f);
        }
        return times(s.color, light) + Color{shine, shine, shine};
    }

    /// Light from the open sky, less from below; what hides it sends back some of the surface's own colour.
    Color sky(const Surface& s, const Vec3f& from, const Noise& noise, std::uint32_t sample) const {
        Color light;
        for (std::uint32_t k = 0; k < sky_rays; ++k) {
            const Vec3f d = matte_direction(s.normal, noise(sample * sky_rays + k));
            light += mix(s.color * 0.12f, Color{0.60f, 0.61f, 0.63f} * (0.78f + 0.22f * dot(d, up_)), open({from, d}));
        }
        return light * (1.f / sky_rays);
    }

    Vec3f towards_lamp(const Noise& noise, std::uint32_t sample) const {
        const Tangents t(lamp_);
        const Pair p = noise(sample + 101);
        const float angle = 2 * std::numbers::pi_v<float> * p.u, radius = lamp_size * std::sqrt(p.v);
        return normalized(lamp_ + t.a * (radius * std::cos(angle)) + t.b * (radius * std::sin(angle)));
    }

    const Stage& stage_;
    Vec3f up_, lamp_;
    RayScene rays_, meshes_;
    std::vector<Facet> facets_;
    float panel_lift_, skin_lift_;
};

}  // namespace

Canvas trace(const Stage& stage) {
    const Tracer tracer(stage);
    Canvas canvas(stage.view.width, stage.view.height, background);
    tbb::parallel_for(tbb::blocked_range2d<int>(0, canvas.height, 16, 0, canvas.width, 16), [&](const auto& tile) {
        for (int y = tile.rows().begin(); y < tile.rows().end(); ++y)
            for (int x = tile.cols().begin(); x < tile.cols().end(); ++x) tracer.pixel(canvas, x, y);
    });
    return canvas;
}

}  // namespace grainray::picture
