// grainray deposit: where the grains lie on the ground, as grids that GIS programs open, a profile and figures.
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "arguments.hpp"
#include "command.hpp"
#include "deposit/deposit.hpp"
#include "frames.hpp"
#include "grainray/output.hpp"
#include "output/files.hpp"
#include "surfaces/surfaces.hpp"

namespace grainray::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
    fs::path input, scene, terrain, profile;
    std::string out, axis;
    std::optional<double> cell, bin;
    double solid_fraction = 0.6;
    std::vector<double> times;
};

/// The run that a frame or a folder is of: its frames by number, and the frame to be mapped.
struct Run {
    std::vector<fs::path> frames;
    fs::path mapped;
};

Run find_run(const fs::path& input) {
    std::error_code error;
    if (!fs::exists(input, error)) throw InputError(fmt::format("{}: there is no such frame or folder", input.string()));
    if (fs::is_directory(input, error)) {
        Run run{frames_in(input), {}};
        run.mapped = run.frames.back();
        return run;
    }
    const fs::path folder = fs::absolute(input).parent_path();
    return {folder.filename() == "frames" ? frames_in(folder) : std::vector{input}, input};
}

/// As the simulation has it, and with the cells of its file.
struct Ground {
    ElevationGrid surface, cells;
};

Ground load(const Options& options, const Run& run) {
    Ground g;
    if (!options.terrain.empty()) {
        g.surface = g.cells = surfaces::read_grid_file(options.terrain, "--terrain: ");
    } else {
        Scene scene = scene_of(run.mapped, options.scene);
        if (!scene.terrain) throw InputError(fmt::format("{}: the scene has no terrain to measure from; give the ground as a grid with --terrain", run.mapped.string()));
        g.surface = load_ground(scene);
        scene.terrain->smooth = 1;
        g.cells = load_ground(scene);
    }
    if (options.cell) g.cells = deposit::cells_of_size(g.surface, *options.cell);
    return g;
}

/// What started: streams may fill an empty scene.
Frame first_with_grains(const Run& run, const Frame& now) {
    for (const fs::path& file : run.frames) {
        if (file == run.mapped) break;
        if (Frame frame = read_frame(file); frame.size() > 0) return frame;
    }
    return now;
}

deposit::Axis axis_of(const Options& options, const Frame& start, const Frame& now) {
    if (options.axis.empty()) return deposit::flow_axis(start, now);
    const Vec3d given = parse_vector("--axis", options.axis);
    return deposit::flow_axis(start, given.x, given.y);
}

void write_profile(const Options& options, const Run& run, const Ground& ground, const deposit::Axis& axis) {
    const auto chosen = !options.times.empty() ? frames_at(run.frames, options.times) : std::vector{run.mapped};
    const double bin = options.bin.value_or(std::max(ground.cells.dx, ground.cells.dy));
    std::string text = "time,distance,depth,deepest,width,speed,ground\n";
    for (const fs::path& file : chosen) {
        const Frame frame = read_frame(file);
        for (const deposit::ProfileRow& row : deposit::profile(deposit::map(frame, ground.surface, ground.cells, options.solid_fraction), ground.cells, axis, bin))
            text += fmt::format("{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.9g}\n", frame.time, row.distance, row.depth, row.deepest, row.width, row.speed, row.ground);
    }
    make_folder(options.profile.parent_path());
    write_text_atomically(options.profile, text);
    fmt::print("profile     {}: {} along the flow, m and m/s\n", options.profile.string(), counted(chosen.size(), "snapshot"));
}

double greatest(const ElevationGrid& map) {
    double most = 0;
    for (const double v : map.heights) most = std::fmax(most, v);
    return most;
}

void write_maps(const std::string& name, const deposit::Maps& maps, double solid_fraction) {
    make_folder(fs::path(name).parent_path());
    const auto write = [&](const char* kind, const ElevationGrid& map, const std::string& what) {
        const std::string file = fmt::format("{}_{}.asc", name, kind);
        surfaces::write_esri_grid(file, map);
        fmt::print("{:<11} {}: {}\n", kind, file, what);
    };
    write("depth", maps.depth, fmt::format("solid volume over area and a solid fraction of {:g}; at most {:.4g} m", solid_fraction, greatest(maps.depth)));
    write("top", maps.top, fmt::format("highest grain above the ground; at most {:.4g} m", greatest(maps.top)));
    write("speed", maps.speed, fmt::format("mean of the grains; at most {:.4g} m/s", greatest(maps.speed)));
}

void report(const std::string& name, const Options& options, const Frame& start, const Frame& now, const deposit::Axis& axis, const deposit::Maps& maps) {
    const deposit::Runout r = deposit::runout(start, now, axis);
    fmt::print("grains      {} at t = {:g} s, {:.6g} m3 solid on the ground{}\n", now.size(), now.time, maps.volume,
               maps.beyond > 0 ? fmt::format(" and {:.4g} m3 beyond the grid or over holes", maps.beyond) : "");
    fmt::print("run-out     {:.5g} m along ({:.3f}, {:.3f}) from the rear of what started to the front, behind which 99 % of the volume lies (95 %: {:.5g} m; farthest grain {:.5g} m)\n",
               r.front, axis.dx, axis.dy, r.front_95, r.farthest);
    fmt::print("front       x = {:.2f}, y = {:.2f} m; {:.4g} m below the rear at the start, reach angle {:.1f} degrees\n", r.x, r.y, r.fall, r.reach_angle);
    fmt::print("centre      travelled {:.5g} m and fell {:.4g} m\n", r.centre_travel, r.centre_fall);
    const nlohmann::ordered_json json{
        {"time", now.time}, {"start_time", start.time}, {"grains", now.size()}, {"solid_fraction", options.solid_fraction}, {"solid_volume", maps.volume}, {"solid_volume_beyond", maps.beyond},
        {"depth_max", greatest(maps.depth)}, {"top_max", greatest(maps.top)}, {"axis", {{"origin", {axis.x, axis.y}}, {"direction", {axis.dx, axis.dy}}}}, {"runout", r.front},
        {"runout_95", r.front_95}, {"farthest", r.farthest}, {"front", {r.x, r.y}}, {"fall", r.fall}, {"reach_angle_degrees", r.reach_angle}, {"centre_travel", r.centre_travel},
        {"centre_fall", r.centre_fall}};
    write_text_atomically(name + ".json", json.dump(2) + '\n');
}

/// NAME for the files: --out without .asc, else deposit/NNNNNN of the run, or beside a lone frame.
std::string name_for(const Options& options, const Run& run) {
    if (!options.out.empty()) return options.out.ends_with(".asc") ? options.out.substr(0, options.out.size() - 4) : options.out;
    const fs::path folder = fs::absolute(run.mapped).parent_path();
    const std::string file = run.mapped.filename().string(), number = file.substr(0, file.find('.'));
    return (folder.filename() == "frames" ? folder.parent_path() / "deposit" / number : folder / number).string();
}

int measure_deposit(const Options& options) {
    if (!options.times.empty() && options.profile.empty()) throw InputError("--times: chooses the snapshots of a profile; give --profile CSV too");
    if (options.bin && options.profile.empty()) throw InputError("--bin: is the length of a profile's bins; give --profile CSV too");
    require_finite("--cell", options.cell);
    const Run run = find_run(options.input);
    const Ground ground = load(options, run);
    const Frame now = read_frame(run.mapped), start = first_with_grains(run, now);
    const std::string name = name_for(options, run);
    const deposit::Maps maps = deposit::map(now, ground.surface, ground.cells, options.solid_fraction);
    write_maps(name, maps, options.solid_fraction);
    const bool has_axis = !options.axis.empty() || start.time != now.time;
    if (!has_axis && options.profile.empty()) return done;  // maps alone: of one frame there is no run-out
    const deposit::Axis axis = axis_of(options, start, now);
    report(name, options, start, now, axis, maps);
    if (!options.profile.empty()) write_profile(options, run, ground, axis);
    return done;
}

}  // namespace

void add_deposit(CLI::App& app, Action& chosen) {
    Command command(app, chosen, "deposit", "Map where the grains lie: depth, top, speed, run-out, profile");
    const auto o = std::make_shared<Options>();
    command.argument("FRAME", o->input, "Frame file, or the folder of a run for its last frame");
    command.option("--scene", o->scene, "FILE", "Scene with the terrain; else FRAME/../../scene.toml");
    command.option("--terrain", o->terrain, "GRID", "Ground to measure from, instead of the scene's");
    command.option("--out", o->out, "NAME", "Start of the file names: NAME_depth.asc, NAME_top.asc, NAME_speed.asc, NAME.json");
    command.option("--cell", o->cell, "M", "Size of the cells, m; else those of the terrain");
    command.option_with_default("--solid-fraction", o->solid_fraction, "SHARE", "Volume of the grains over that of the deposit");
    command.option("--axis", o->axis, "X,Y,0", "Direction of the flow; else from where the grains were to where they are");
    command.option("--profile", o->profile, "CSV", "Distance along the flow, depth, width, speed");
    command.list("--times", o->times, "S,S,...", "Times of the profile's snapshots, s; else that of the frame");
    command.option("--bin", o->bin, "M", "Length of the profile's bins, m; else a cell");
    command.footer("Example: grainray deposit slide --out slide --profile slide_profile.csv --times 0,5,20,40,70,100");
    command.action([o] { return measure_deposit(*o); });
}

}  // namespace grainray::cli
