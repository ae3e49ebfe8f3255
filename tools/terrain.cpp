// grainray terrain flume: a pair of grids for examples/debris_flow.toml, for whoever has no data at hand.
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "arguments.hpp"
#include "command.hpp"
#include "surfaces/surfaces.hpp"

namespace grainray::cli {
namespace {

struct Options {
    std::string out = "flume";
    std::optional<double> cell;
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

int write_flume(const std::string& out, double cell) {
    if (!(cell >= 0.25 && cell <= 50)) throw InputError(fmt::format("--cell {}: must be from 0.25 to 50 m", cell));
    ElevationGrid after{static_cast<std::int64_t>(length_x / cell) + 1, static_cast<std::int64_t>(width_y / cell) + 1, 0, 0, cell, cell, {}};
    ElevationGrid before = after;
    double volume = 0;
    for (std::int64_t j = 0; j < after.rows; ++j)
        for (std::int64_t i = 0; i < after.columns; ++i) {
            const double x = static_cast<double>(i) * cell, y = static_cast<double>(j) * cell, z = bare_slope(x, y), depth = scoop(x, y);
            before.heights.push_back(z);
            after.heights.push_back(z - depth);
            volume += depth * cell * cell;
        }
    surfaces::write_esri_grid(out + "_before.asc", before);
    surfaces::write_esri_grid(out + "_after.asc", after);
    fmt::print("{0}_before.asc and {0}_after.asc: {1} x {2} nodes, {3} m apart, {4:.0f} m3 to slide\n", out, after.columns, after.rows, cell, volume);
    return done;
}

}  // namespace

void add_terrain(CLI::App& app, Action& chosen) {
    Command command(app, chosen, "terrain", "Make a synthetic pair of elevation grids");
    command.action([]() -> int { throw InputError("terrain: say what to make: terrain flume; see grainray terrain --help"); });
    Command flume(command.app(), chosen, "flume", "A channel on a slope that runs out on a plain, before and after a slide");
    const auto options = std::make_shared<Options>();
    flume.option_with_default("--out", options->out, "NAME", "Start of the file names");
    flume.option("--cell", options->cell, "M", "Distance of nodes, m; else 5");
    flume.footer("Example: grainray terrain flume --out examples/flume && grainray run examples/debris_flow.toml");
    flume.action([options] { return write_flume(options->out, options->cell.value_or(5)); });
}

}  // namespace grainray::cli
