// A picture from a frame: read Impl::draw() as the table of contents of this folder.
#include "grainray/render.hpp"

#include <fmt/format.h>

#include "render/overlay.hpp"
#include "render/sheet.hpp"
#include "render/strokes.hpp"
#include "render/surroundings.hpp"
#include "render/trace.hpp"

namespace grainray {

namespace {

using namespace picture;

void check_size(const char* key, std::int64_t pixels) {
    if (pixels < 16 || pixels > 16384) throw InputError(fmt::format("render.{} = {} must be 16 to 16384 pixels", key, pixels));
}

void check(const RenderSettings& s) {
    check_size("width", s.width);
    check_size("height", s.height);
    if (!(s.mesh_opacity >= 0 && s.mesh_opacity <= 1))
        throw InputError(fmt::format("render.mesh_opacity = {} must be from 0 (not seen) to 1 (nothing seen through it)", s.mesh_opacity));
    if (s.mesh_cut && !(length(*s.mesh_cut) > 0 && std::isfinite(length(*s.mesh_cut))))
        throw InputError("render.mesh_cut is no direction: give a vector that is not zero");
}

Image to_image(const Canvas& canvas) {
    Image image{canvas.width, canvas.height, {}};
    image.rgb.reserve(3 * canvas.color.size());
    for (const Color& c : canvas.color)
        for (int channel = 0; channel < 3; ++channel)
            image.rgb.push_back(static_cast<std::uint8_t>(std::clamp(c[channel], 0.f, 1.f) * 255 + 0.5f));
    return image;
}

/// What frames that share a camera show together: a share of the particles of each.
struct Overview {
    Frame particles;
    std::optional<Box> meshes;
    std::vector<double> times;
    std::optional<Scale> scale;

    void add(const Frame& frame) {
        constexpr std::size_t share = 20000;  // of each frame
        for (std::size_t i = 0; i < frame.size(); i += frame.size() / share + 1) {
            particles.position.push_back(frame.position[i]);
            particles.radius.push_back(frame.radius[i]);
        }
        times.push_back(frame.time);
        particles.time = frame.time;
    }
};

/// Camera and ground of one picture, or of all that share them.
struct Setting {
    std::optional<Relief> relief;
    View view;
    const Relief* ground() const { return relief ? &*relief : nullptr; }
};

/// Particles beyond the block of terrain would hang in the void.
std::size_t leave_out_beyond(const Relief& relief, Subject& subject) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < subject.spheres.size(); ++k) {
        const Vec3f& p = subject.spheres[k].centre;
        if (p.x < relief.box.lower.x || p.y < relief.box.lower.y || p.x > relief.box.upper.x || p.y > relief.box.upper.y) continue;
        subject.spheres[kept] = subject.spheres[k];
        subject.index[kept++] = subject.index[k];
    }
    const std::size_t left_out = subject.spheres.size() - kept;
    subject.spheres.resize(kept);
    subject.index.resize(kept);
    return left_out;
}

}  // namespace

struct Renderer::Impl {
    Scene scene;
    RenderSettings settings;
    Surroundings surroundings;
    Overview overview;
    mutable std::optional<Subject> shared_subject;  ///< these two are made when first needed
    mutable std::optional<Setting> shared;

    Impl(const Scene& s, const RenderSettings& r) : scene(s), settings(r), surroundings((check(r), s)) {
        scene.terrain.reset();  // held by the surroundings
        scene.meshes.clear();
    }

    std::optional<Box> mesh_bounds(double time) const {
        if (!surroundings.has_meshes()) return {};
        return surroundings.mesh_bounds(time);
    }
    Paint paint_of(const Frame& frame, const Subject& subject) const { return make_paint(frame, scene, settings, subject, surroundings, overview.scale); }

    void include(const Frame& frame) {
        const auto box = mesh_bounds(frame.time);
        const auto scale = make_paint(frame, scene, settings, make_subject(frame, scene, box), surroundings, {}).scale;
        if (scale) overview.scale = overview.scale ? joined(*overview.scale, *scale) : *scale;
        if (box && overview.meshes) grow(*overview.meshes, *box);
        else overview.meshes = box;
        overview.add(frame);
        shared_subject.reset();
        shared.reset();
    }

    Setting set(const Subject& subject, const std::vector<double>& times, const Margins& margins, int width, int height) const {
        Setting result;
        if (surroundings.ground()) result.relief = make_relief(*surroundings.ground(), subject);
        std::vector<Vec3f> corners;
        for (const double time : times)
            for (const Skin& mesh : surroundings.meshes_at(time, subject.origin))
                corners.insert(corners.end(), mesh.vertices.begin(), mesh.vertices.end());
        RenderSettings sized = settings;
        sized.width = width, sized.height = height;
        const Room room = make_room(scene, subject, settings.camera.up, times.front());
        result.view = make_view(sized, {subject, room, result.ground(), corners}, margins);
        return result;
    }

    const Subject& subject_to_share() const {
        if (!shared_subject) shared_subject = make_subject(overview.particles, scene, overview.meshes);
        return *shared_subject;
    }
    const Setting& setting_to_share(const Margins& margins, int width, int height) const {
        if (!shared || shared->view.width != width || shared->view.height != height)
            shared = set(subject_to_share(), overview.times, margins, width, height);
        return *shared;
    }

    struct Drawn {
        Canvas canvas;
        Paint paint;
        std::size_t left_out = 0;
    };
    /// `margins`: given what must be said about the colours; `unit`: of letters.
    Drawn draw(const Frame& frame, const std::function<Margins(const Paint&)>& margins, int width, int height, float unit) const {
        const bool share = !overview.times.empty();
        Subject subject = share ? make_subject_like(subject_to_share(), frame) : make_subject(frame, scene, mesh_bounds(frame.time));
        Paint paint = paint_of(frame, subject);
        const Setting own = share ? Setting{} : set(subject, {frame.time}, margins(paint), width, height);
        const Setting& setting = share ? setting_to_share(margins(paint), width, height) : own;
        std::size_t left_out = 0;
        if (setting.relief && (left_out = leave_out_beyond(*setting.relief, subject)) > 0) paint = paint_of(frame, subject);

        const Vec3d up = settings.camera.up;
        const Room room = make_room(scene, subject, up, frame.time);
        const auto meshes = settings.mesh_opacity > 0 ? surroundings.meshes_at(frame.time, subject.origin) : std::vector<Skin>{};
        const std::optional<Cut> cut = cut_of(subject);
        Canvas canvas = trace({setting.view, subject, room, setting.ground(), meshes, static_cast<float>(settings.mesh_opacity), cut, paint.colors, up});
        draw_outlines(canvas, setting.view, room);
        draw_edges(canvas, setting.view, meshes, cut);
        if (setting.relief) draw_scale_bar(canvas, setting.view, *setting.relief, unit);
        return {std::move(canvas), std::move(paint), left_out};
    }

    /// Through the middle of the meshes as they stand at the start, so that it stays where it is when they move.
    std::optional<Cut> cut_of(const Subject& subject) const {
        if (!settings.mesh_cut || !surroundings.has_meshes()) return {};
        const Box box = surroundings.mesh_bounds(0);
        return Cut{convert<float>((box.lower + box.upper) * 0.5 - subject.origin), convert<float>(normalized(*settings.mesh_cut))};
    }
};

Renderer::Renderer(const Scene& scene, const RenderSettings& settings) : impl_(std::make_unique<Impl>(scene, settings)) {}
Renderer::~Renderer() = default;

void Renderer::include(const Frame& frame) { impl_->include(frame); }

std::optional<Renderer::ColorRange> Renderer::shared_colors() const {
    if (!impl_->overview.scale) return {};
    return ColorRange{impl_->overview.scale->low, impl_->overview.scale->high};
}

Image Renderer::draw(const Frame& frame) const {
    const int width = static_cast<int>(impl_->settings.width), height = static_cast<int>(impl_->settings.height);
    auto [canvas, paint, left_out] = impl_->draw(frame, [&](const Paint& p) { return margins_for(p, width, height); }, width, height, unit_of(width, height));
    draw_legend(canvas, paint);
    draw_caption(canvas, caption(frame.time, frame.size(), left_out));
    return to_image(canvas);
}

Image Renderer::sheet(std::size_t count, const std::function<Frame(std::size_t)>& frame_of) const {
    Canvas page(static_cast<int>(impl_->settings.width), static_cast<int>(impl_->settings.height), {1, 1, 1});
    std::optional<Paint> legend;
    for (std::size_t k = 0; k < count; ++k) {
        const Frame frame = frame_of(k);
        const Cell cell = cell_of(page, count, k);
        auto [canvas, paint, left_out] = impl_->draw(frame, [](const Paint&) { return cell_margins; }, cell.width, cell.height, 0.75f * unit_of(page));
        place(page, cell, canvas, frame.time);
        if (!legend || paint.kinds.size() > legend->kinds.size()) legend = std::move(paint);
    }
    if (legend) draw_legend(page, *legend);
    return to_image(page);
}

Image render(const Frame& frame, const Scene& scene, const RenderSettings& settings) { return Renderer(scene, settings).draw(frame); }

}  // namespace grainray
