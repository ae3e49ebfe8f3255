// Particles from a CSV file: columns by the names of the header, others are skipped.
#include <fmt/format.h>

#include <array>
#include <fstream>

#include "scene/csv.hpp"
#include "scene/place.hpp"
#include "scene/suggest.hpp"

namespace grainray::scene {
namespace {

constexpr std::array<std::string_view, 10> column_names{"x", "y", "z", "radius", "vx", "vy", "vz", "wx", "wy", "wz"};
using Columns = std::array<std::ptrdiff_t, 10>;  ///< where each is in a row; -1: nowhere

Columns find_columns(const std::vector<std::string_view>& header, const std::string& file, std::size_t line) {
    Columns columns;
    columns.fill(-1);
    for (std::size_t c = 0; c < header.size(); ++c)
        for (std::size_t k = 0; k < column_names.size(); ++k) {
            if (header[c] != column_names[k]) continue;
            if (columns[k] >= 0) reject_row(file, line, fmt::format("column '{}' appears twice", header[c]));
            columns[k] = static_cast<std::ptrdiff_t>(c);
        }
    const auto require = [&](std::size_t k) {
        if (columns[k] >= 0) return;
        reject_row(file, line, fmt::format("the header has no column '{}'{} Needed: x, y, z, radius; all or none of vx, vy, vz "
                                       "and of wx, wy, wz",
                                       column_names[k], did_you_mean(column_names[k], header)));
    };
    for (std::size_t k = 0; k < 4; ++k) require(k);
    for (const std::size_t k : {4u, 7u})
        if (columns[k] >= 0 || columns[k + 1] >= 0 || columns[k + 2] >= 0) require(k), require(k + 1), require(k + 2);
    return columns;
}

Vec3d triple(const std::array<double, 10>& values, std::size_t k) { return {values[k], values[k + 1], values[k + 2]}; }

}  // namespace

void place_file(const Scene& scene, const ParticleGroup& group, const ParticleFile& placement, InitialState& state) {
    const auto path = placement.path.is_absolute() ? placement.path : scene.file.parent_path() / placement.path;
    const std::string file = path.string();
    std::ifstream in(path);
    std::error_code ignored;
    if (!in || std::filesystem::is_directory(path, ignored))
        throw InputError(fmt::format("{} = \"{}\": {} cannot be read; give a CSV file, relative to the scene file",
                                     place_of(scene, group, "path"), placement.path.string(), file));
    std::string row;
    std::size_t line = 0;
    if (!next_csv_row(in, row, line)) reject_row(file, 1, "is empty; expected a header such as x,y,z,radius");
    const std::size_t width = split_row(row).size();
    const Columns columns = find_columns(split_row(row), file, line);
    while (next_csv_row(in, row, line)) {
        const auto cells = split_row(row);
        if (cells.size() != width)
            reject_row(file, line, fmt::format("has {} values, the header has {} columns", cells.size(), width));
        std::array<double, 10> values{};
        for (std::size_t k = 0; k < values.size(); ++k)
            if (columns[k] >= 0)
                values[k] = csv_number(cells[static_cast<std::size_t>(columns[k])], column_names[k], file, line);
        if (!(values[3] > 0)) reject_row(file, line, fmt::format("column 'radius': {} must be greater than 0", values[3]));
        state.positions.push_back(triple(values, 0));
        state.radii.push_back(values[3]);
        state.velocities.push_back(columns[4] >= 0 ? triple(values, 4) : group.velocity);
        state.angular_velocities.push_back(columns[7] >= 0 ? triple(values, 7) : group.angular_velocity);
    }
}

}  // namespace grainray::scene
