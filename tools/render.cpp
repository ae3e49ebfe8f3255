// grainray render: pictures of frames.
#include "grainray/render.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>

#include <fmt/format.h>

#include "arguments.hpp"
#include "command.hpp"
#include "run_folder.hpp"

namespace grainray::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
    fs::path input, scene, out;
    std::string color_by, eye, target, up, size;
    std::optional<double> minimum, maximum, field_of_view;
};

/// The frames of a run's folder, or of a folder of frames, by number.
std::vector<fs::path> frames_in(const fs::path& folder) {
    std::error_code error;
    const fs::path place = fs::is_directory(folder / "frames", error) ? folder / "frames" : folder;
    std::vector<fs::path> frames;
    for (const fs::directory_entry& entry : fs::directory_iterator(place, error))
        if (frame_number(entry.path()) >= 0 && entry.path().extension() != ".tmp") frames.push_back(entry.path());
    if (error) throw InputError(fmt::format("{}: cannot be read: {}", place.string(), error.message()));
    if (frames.empty()) throw InputError(fmt::format("{}: holds no frames (NNNNNN.vtp); give a frame or the folder of a run", folder.string()));
    std::sort(frames.begin(), frames.end(), [](const fs::path& a, const fs::path& b) { return frame_number(a) < frame_number(b); });
    return frames;
}

fs::path run_folder_of(const fs::path& frame) { return fs::absolute(frame).parent_path().parent_path(); }

Scene scene_for(const Options& options, const fs::path& frame) {
    if (!options.scene.empty()) return load_scene(options.scene);
    const fs::path file = run_folder_of(frame) / "scene.toml";
    std::error_code error;
    if (!fs::exists(file, error))
        throw InputError(fmt::format("{}: no scene at {}; give the scene the frame belongs to with --scene", frame.string(), file.string()));
    return load_scene(file);
}

RenderSettings settings_for(const Options& options, const Scene& scene) {
    RenderSettings s = scene.render;
    if (!options.color_by.empty()) s.color_by = options.color_by;
    if (options.minimum) s.color_minimum = options.minimum;
    if (options.maximum) s.color_maximum = options.maximum;
    require_finite("--min", options.minimum);
    require_finite("--max", options.maximum);
    if (s.color_minimum && s.color_maximum && !(*s.color_maximum > *s.color_minimum))
        throw InputError(fmt::format("--max: {} must be greater than the first colour's value, {}", *s.color_maximum, *s.color_minimum));
    if (!options.eye.empty()) s.camera.eye = parse_vector("--eye", options.eye);
    if (!options.target.empty()) s.camera.target = parse_vector("--target", options.target);
    if (!options.up.empty()) s.camera.up = parse_vector("--up", options.up);
    if (options.field_of_view) s.camera.field_of_view = *options.field_of_view;
    if (!(s.camera.field_of_view > 0 && s.camera.field_of_view < 180))
        throw InputError(fmt::format("--fov: {} is not an angle between 0 and 180 degrees", s.camera.field_of_view));
    if (s.camera.up == Vec3d{}) throw InputError("--up: must not be the zero vector; write for example --up 0,0,1");
    if (s.camera.eye && s.camera.target && *s.camera.eye == *s.camera.target) throw InputError("--target: must differ from --eye");
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

void make_folder(const fs::path& folder) {
    std::error_code error;
    if (!folder.empty()) fs::create_directories(folder, error);
    if (error) throw InputError(fmt::format("folder {}: cannot be made: {}", folder.string(), error.message()));
}

fs::path picture_in(const fs::path& folder, const fs::path& frame) {
    const std::string name = frame.filename().string();
    return folder / (name.substr(0, name.find('.')) + ".png");
}

int render_frames(const Options& options) {
    std::error_code error;
    if (!fs::exists(options.input, error)) throw InputError(fmt::format("{}: there is no such frame or folder", options.input.string()));
    const bool all = fs::is_directory(options.input, error);
    const std::vector<fs::path> frames = all ? frames_in(options.input) : std::vector{options.input};
    const Scene scene = scene_for(options, frames.front());
    const RenderSettings settings = settings_for(options, scene);
    const bool to_file = !all && !options.out.empty() && !fs::is_directory(options.out, error);
    if (to_file && options.out.extension() != ".png")
        throw InputError(fmt::format("--out: {} does not end in .png; pictures are written as PNG", options.out.string()));
    const fs::path folder = to_file ? options.out.parent_path() : options.out.empty() ? default_folder(frames.front()) : options.out;
    for (const fs::path& frame : frames) {
        const Image image = render(read_frame(frame), scene, settings);
        make_folder(folder);
        const fs::path picture = to_file ? options.out : picture_in(folder, frame);
        write_png(picture, image);
        fmt::print("{}\n", picture.string());
    }
    return done;
}

}  // namespace

void add_render(CLI::App& app, Action& chosen) {
    Command command(app, chosen, "render", "Draw a frame, or every frame of a run, as PNG");
    const auto o = std::make_shared<Options>();
    command.argument("FRAME", o->input, "Frame file (.vtp, .csv), or the folder of a run for all its frames");
    command.option("--scene", o->scene, "FILE", "Scene with planes and camera; else FRAME/../../scene.toml");
    command.option("--out", o->out, "PNG|DIR", "Picture, or folder for pictures; else DIR/pictures of the run");
    command.option("--color-by", o->color_by, "FIELD", "Field shown as colour, such as speed, radius, coordination");
    command.option("--min", o->minimum, "VALUE", "Value of the first colour; else the smallest in each picture");
    command.option("--max", o->maximum, "VALUE", "Value of the last colour; else the largest in each picture");
    command.option("--eye", o->eye, "X,Y,Z", "Position of the camera, m");
    command.option("--target", o->target, "X,Y,Z", "Point it looks at, m");
    command.option("--up", o->up, "X,Y,Z", "Direction that is up in the picture");
    command.option("--fov", o->field_of_view, "DEGREES", "Vertical field of view, degrees");
    command.option("--size", o->size, "WxH", "Pixels");
    command.footer("Example: grainray render column/frames/000004.vtp --color-by coordination --eye 8,-20,6 --size 1920x1080");
    command.action([o] { return render_frames(*o); });
}

}  // namespace grainray::cli
