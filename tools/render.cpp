// grainray render: pictures of frames, a film, a sheet of snapshots.
#include "grainray/render.hpp"

#include <unistd.h>

#include <cstdio>
#include <optional>

#include <fmt/format.h>

#include "arguments.hpp"
#include "command.hpp"
#include "film.hpp"
#include "frames.hpp"

namespace grainray::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
    fs::path input, scene, out, movie, sheet;
    std::string color_by, eye, target, up, size, cut;
    std::optional<double> minimum, maximum, field_of_view, opacity, rate;
    std::vector<double> times;
};

void set_colors(const Options& options, RenderSettings& s) {
    if (!options.color_by.empty()) s.color_by = options.color_by;
    if (options.minimum) s.color_minimum = options.minimum;
    if (options.maximum) s.color_maximum = options.maximum;
    require_finite("--min", options.minimum);
    require_finite("--max", options.maximum);
    if (s.color_minimum && s.color_maximum && !(*s.color_maximum > *s.color_minimum))
        throw InputError(fmt::format("--max: {} must be greater than the first colour's value, {}", *s.color_maximum, *s.color_minimum));
    if (options.opacity) s.mesh_opacity = *options.opacity;
    if (!(s.mesh_opacity >= 0 && s.mesh_opacity <= 1)) throw InputError(fmt::format("--mesh-opacity: {} must be from 0 (not seen) to 1 (nothing seen through)", s.mesh_opacity));
    if (!options.cut.empty()) s.mesh_cut = parse_vector("--cut", options.cut);
    if (s.mesh_cut && *s.mesh_cut == Vec3d{}) throw InputError("--cut: must not be the zero vector; write for example --cut 0,-1,0");
}

void set_camera(const Options& options, RenderSettings& s) {
    if (!options.eye.empty()) s.camera.eye = parse_vector("--eye", options.eye);
    if (!options.target.empty()) s.camera.target = parse_vector("--target", options.target);
    if (!options.up.empty()) s.camera.up = parse_vector("--up", options.up);
    if (options.field_of_view) s.camera.field_of_view = *options.field_of_view;
    if (!(s.camera.field_of_view > 0 && s.camera.field_of_view < 180))
        throw InputError(fmt::format("--fov: {} is not an angle between 0 and 180 degrees", s.camera.field_of_view));
    if (s.camera.up == Vec3d{}) throw InputError("--up: must not be the zero vector; write for example --up 0,0,1");
    if (s.camera.eye && s.camera.target && *s.camera.eye == *s.camera.target) throw InputError("--target: must differ from --eye");
}

RenderSettings settings_for(const Options& options, const Scene& scene) {
    RenderSettings s = scene.render;
    set_colors(options, s);
    set_camera(options, s);
    if (!options.size.empty()) {
        const PixelSize size = parse_size("--size", options.size);
        s.width = size.width;
        s.height = size.height;
    }
    return s;
}

/// Pictures of a run go to DIR/pictures, those of a lone frame beside it.
fs::path default_folder(const fs::path& frame) {
    const fs::path folder = fs::absolute(frame).parent_path();
    return folder.filename() == "frames" ? folder.parent_path() / "pictures" : folder;
}

fs::path picture_in(const fs::path& folder, const fs::path& frame) {
    const std::string name = frame.filename().string();
    return folder / (name.substr(0, name.find('.')) + ".png");
}

void require_png(const char* option, const fs::path& path) {
    if (path.extension() != ".png") throw InputError(fmt::format("{}: {} does not end in .png; pictures are written as PNG", option, path.string()));
}

/// Says on a terminal how far a film has got.
void tell(const char* what, std::size_t k, std::size_t count) {
    if (isatty(STDERR_FILENO)) fmt::print(stderr, "\r{} {} of {}{}", what, k, count, k == count ? "\n" : "");
}

void include_all(Renderer& renderer, const std::vector<fs::path>& frames) {
    for (std::size_t k = 0; k < frames.size(); ++k) {
        renderer.include(read_frame(frames[k]));
        tell("reading", k + 1, frames.size());
    }
}

std::string colors_text(const Renderer& renderer, const RenderSettings& s) {
    const auto range = renderer.shared_colors();
    return range ? fmt::format(", one camera, {} coloured from {:g} to {:g}", s.color_by, range->low, range->high) : ", one camera";
}

void make_sheet(const Options& options, const std::vector<fs::path>& frames, const Scene& scene, RenderSettings settings) {
    constexpr std::size_t snapshots = 6;
    require_png("--sheet", options.sheet);
    if (options.size.empty()) settings.width = 1920, settings.height = 1080;
    const auto chosen = frames_at(frames, options.times.empty() ? spread_times(frames, snapshots) : options.times);
    Renderer renderer(scene, settings);
    include_all(renderer, chosen);
    const Image image = renderer.sheet(chosen.size(), [&](std::size_t k) { return read_frame(chosen[k]); });
    make_folder(options.sheet.parent_path());
    write_png(options.sheet, image);
    fmt::print("{}: {}{}\n", options.sheet.string(), counted(chosen.size(), "snapshot"), colors_text(renderer, settings));
}

void make_movie(const Options& options, const std::vector<fs::path>& frames, const Scene& scene, const RenderSettings& settings) {
    Film film(options.movie, options.rate.value_or(25));
    Renderer renderer(scene, settings);
    include_all(renderer, frames);
    make_folder(options.movie.parent_path());
    for (std::size_t k = 0; k < frames.size(); ++k) {
        film.add(renderer.draw(read_frame(frames[k])));
        tell("drawing", k + 1, frames.size());
    }
    fmt::print("{}{}\n", film.finish(), colors_text(renderer, settings));
}

void make_pictures(const Options& options, const std::vector<fs::path>& frames, bool all, const Scene& scene, const RenderSettings& settings) {
    std::error_code error;
    const bool to_file = !all && !options.out.empty() && !fs::is_directory(options.out, error);
    if (to_file) require_png("--out", options.out);
    const fs::path folder = to_file ? options.out.parent_path() : options.out.empty() ? default_folder(frames.front()) : options.out;
    const Renderer renderer(scene, settings);
    for (const fs::path& frame : frames) {
        const Image image = renderer.draw(read_frame(frame));
        make_folder(folder);
        const fs::path picture = to_file ? options.out : picture_in(folder, frame);
        write_png(picture, image);
        fmt::print("{}\n", picture.string());
    }
}

int render_frames(const Options& options) {
    std::error_code error;
    if (!fs::exists(options.input, error)) throw InputError(fmt::format("{}: there is no such frame or folder", options.input.string()));
    const bool all = fs::is_directory(options.input, error), joined = !options.movie.empty() || !options.sheet.empty();
    if (joined && !options.out.empty()) throw InputError("--out: --movie and --sheet name their own files; leave it out");
    if (joined && !all) throw InputError(fmt::format("{}: a film or a sheet needs the folder of a run, not one frame", options.input.string()));
    if (!options.times.empty() && options.sheet.empty()) throw InputError("--times: chooses the snapshots of a sheet; give --sheet PNG too");
    if (options.rate && options.movie.empty()) throw InputError("--fps: is the frame rate of a film; give --movie FILE too");
    const std::vector<fs::path> frames = all ? frames_in(options.input) : std::vector{options.input};
    const Scene scene = scene_of(frames.front(), options.scene);
    const RenderSettings settings = settings_for(options, scene);
    if (!options.sheet.empty()) make_sheet(options, frames, scene, settings);
    if (!options.movie.empty()) make_movie(options, frames, scene, settings);
    if (!joined) make_pictures(options, frames, all, scene, settings);
    return done;
}

}  // namespace

void add_render(CLI::App& app, Action& chosen) {
    Command command(app, chosen, "render", "Draw a frame, or every frame of a run, as PNG, as a film or as a sheet of snapshots");
    const auto o = std::make_shared<Options>();
    command.argument("FRAME", o->input, "Frame file (.vtp, .csv), or the folder of a run for all its frames");
    command.option("--scene", o->scene, "FILE", "Scene with boundaries and camera; else FRAME/../../scene.toml");
    command.option("--out", o->out, "PNG|DIR", "Picture, or folder for pictures; else DIR/pictures of the run");
    command.option("--movie", o->movie, "FILE", "Film (.mp4, .webm, .gif ...) of a run, by ffmpeg; pictures in a folder where there is none");
    command.option("--fps", o->rate, "RATE", "Frames of the film a second; else 25");
    command.option("--sheet", o->sheet, "PNG", "Snapshots of a run side by side, six unless --times says otherwise");
    command.list("--times", o->times, "S,S,...", "Times of the snapshots, s");
    command.option("--color-by", o->color_by, "FIELD", "Field shown as colour, such as speed, depth, radius, coordination");
    command.option("--min", o->minimum, "VALUE", "Value of the first colour; else the smallest in the picture, the film, the sheet");
    command.option("--max", o->maximum, "VALUE", "Value of the last colour; else the largest");
    command.option("--mesh-opacity", o->opacity, "SHARE", "0: meshes are not seen; 1: nothing is seen through them; else 0.2");
    command.option("--cut", o->cut, "X,Y,Z", "Leave out the half of the meshes towards this direction");
    command.option("--eye", o->eye, "X,Y,Z", "Position of the camera, m");
    command.option("--target", o->target, "X,Y,Z", "Point it looks at, m");
    command.option("--up", o->up, "X,Y,Z", "Direction that is up in the picture");
    command.option("--fov", o->field_of_view, "DEGREES", "Vertical field of view, degrees");
    command.option("--size", o->size, "WxH", "Pixels");
    command.footer("Example: grainray render column/frames/000004.vtp --color-by coordination --eye 8,-20,6 --size 1920x1080\n"
                   "         grainray render slide --sheet slide.png --times 0,5,20,40,70,100 --movie slide.mp4");
    command.action([o] { return render_frames(*o); });
}

}  // namespace grainray::cli
