// grainray terrain flume: a pair of grids for examples/debris_flow.toml, for whoever has no data at hand.
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "command.hpp"
#include "commands.hpp"
#include "surfaces/surfaces.hpp"

namespace grainray::cli {
namespace {

struct Options {
    std::string out = "flume";
    double cell = 5;
};

constexpr double length_x = 600, width_y = 200;  // m

/// A slope of 32 degrees that bends into a plain of 2 degrees at x = 300 m, with a channel along its middle that widens.
double bare_slope(double x, double y) {
    constexpr double steep = 0.625, gentle = 0.035, bend = 300, soft = 40;
    const double t = (x - bend) / soft, slope_part = -steep * x + (steep - gentle) * soft * (t > 30 ? t : std::log1p(std::exp(t)));
    const double across = (y - 0.5 * width_y) / (0.5 * width_y), walls = 25 * (1 - 0.8 / (1 + std::exp(-(x - 380) / 40)));
    return 400 + slope_part + walls * across * across;
}

/// Depth of the failure: a paraboloid high up the channel, 8 m deep.
double scoop(double x, double y) {
    const double u = (x - 90) / 55, v = (y - 0.5 * width_y) / 28, left = 1 - u * u - v * v;
    return left > 0 ? 8 * left : 0;
}

int write_flume(const Options& options) {
    if (!(options.cell >= 0.25 && options.cell <= 50)) throw InputError(fmt::format("--cell {}: must be from 0.25 to 50 m", options.cell));
    ElevationGrid after{static_cast<std::int64_t>(length_x / options.cell) + 1, static_cast<std::int64_t>(width_y / options.cell) + 1, 0, 0, options.cell, options.cell, {}};
    ElevationGrid before = after;
    double volume = 0;
    for (std::int64_t j = 0; j < after.rows; ++j)
        for (std::int64_t i = 0; i < after.columns; ++i) {
            const double x = static_cast<double>(i) * options.cell, y = static_cast<double>(j) * options.cell, z = bare_slope(x, y), depth = scoop(x, y);
            before.heights.push_back(z);
            after.heights.push_back(z - depth);
            volume += depth * options.cell * options.cell;
        }
    surfaces::write_esri_grid(options.out + "_before.asc", before);
    surfaces::write_esri_grid(options.out + "_after.asc", after);
    fmt::print("{0}_before.asc and {0}_after.asc: {1} x {2} nodes, {3} m apart, {4:.0f} m3 to slide\n", options.out, after.columns, after.rows, options.cell, volume);
    return done;
}

}  // namespace

void add_terrain(CLI::App& app, Action& chosen) {
    CLI::App* command = app.add_subcommand("terrain", "Make a synthetic pair of elevation grids");
    CLI::App* flume = command->add_subcommand("flume", "A channel on a slope that runs out on a plain, before and after a slide");
    command->require_subcommand(1);
    const auto options = std::make_shared<Options>();
    flume->add_option("--out", options->out, "Start of the file names; else flume")->type_name("NAME")->check(not_empty());
    flume->add_option("--cell", options->cell, "Distance of nodes, m; else 5")->type_name("M");
    flume->footer("Example: grainray terrain flume --out examples/flume && grainray run examples/debris_flow.toml");
    flume->callback([options, &chosen] { chosen = [options] { return write_flume(*options); }; });
}

}  // namespace grainray::cli
