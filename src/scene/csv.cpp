// Particles from a CSV file: columns by the names of the header, others are skipped.
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>

#include "scene/place.hpp"
#include "scene/suggest.hpp"

namespace grainray::scene {
namespace {

constexpr std::array<std::string_view, 10> column_names{"x", "y", "z", "radius", "vx", "vy", "vz", "wx", "wy", "wz"};
using Columns = std::array<std::ptrdiff_t, 10>;  ///< where each is in a row; -1: nowhere

[[noreturn]] void reject(const std::string& file, std::size_t line, const std::string& why) {
    throw InputError(fmt::format("{}:{}: {}", file, line, why));
}

std::vector<std::string_view> split(std::string_view row) {
    std::vector<std::string_view> cells;
    for (;;) {
        const auto comma = row.find(',');
        std::string_view cell = row.substr(0, comma);
        while (!cell.empty() && std::string_view(" \t\r\"").find(cell.front()) != std::string_view::npos)
            cell.remove_prefix(1);
        while (!cell.empty() && std::string_view(" \t\r\"").find(cell.back()) != std::string_view::npos)
            cell.remove_suffix(1);
        cells.push_back(cell);
        if (comma == std::string_view::npos) return cells;
        row.remove_prefix(comma + 1);
    }
}

/// The next row that is neither empty nor a comment; false at the end.
bool next_row(std::istream& in, std::string& row, std::size_t& line) {
    while (std::getline(in, row)) {
        if (++line == 1 && row.starts_with("\xef\xbb\xbf")) row.erase(0, 3);  // byte order mark
        if (!row.empty() && row.back() == '\r') row.pop_back();
        const auto first = row.find_first_not_of(" \t");
        if (first != std::string::npos && row[first] != '#') return true;
    }
    return false;
}

Columns find_columns(const std::vector<std::string_view>& header, const std::string& file, std::size_t line) {
    Columns columns;
    columns.fill(-1);
    for (std::size_t c = 0; c < header.size(); ++c)
        for (std::size_t k = 0; k < column_names.size(); ++k) {
            if (header[c] != column_names[k]) continue;
            if (columns[k] >= 0) reject(file, line, fmt::format("column '{}' appears twice", header[c]));
            columns[k] = static_cast<std::ptrdiff_t>(c);
        }
    const auto require = [&](std::size_t k) {
        if (columns[k] >= 0) return;
        reject(file, line, fmt::format("the header has no column '{}'{} Needed: x, y, z, radius; all or none of vx, vy, vz "
                                       "and of wx, wy, wz",
                                       column_names[k], did_you_mean(column_names[k], header)));
    };
    for (std::size_t k = 0; k < 4; ++k) require(k);
    for (const std::size_t k : {4u, 7u})
        if (columns[k] >= 0 || columns[k + 1] >= 0 || columns[k + 2] >= 0) require(k), require(k + 1), require(k + 2);
    return columns;
}

double number(std::string_view cell, std::string_view column, const std::string& file, std::size_t line) {
    double value = 0;
    if (cell.starts_with('+')) cell.remove_prefix(1);
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc{} || end != cell.data() + cell.size())
        reject(file, line, fmt::format("column '{}': '{}' is not a number", column, cell));
    if (!std::isfinite(value)) reject(file, line, fmt::format("column '{}': {} is not a finite number", column, value));
    return value;
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
    if (!next_row(in, row, line)) reject(file, 1, "is empty; expected a header such as x,y,z,radius");
    const std::size_t width = split(row).size();
    const Columns columns = find_columns(split(row), file, line);
    while (next_row(in, row, line)) {
        const auto cells = split(row);
        if (cells.size() != width)
            reject(file, line, fmt::format("has {} values, the header has {} columns", cells.size(), width));
        std::array<double, 10> values{};
        for (std::size_t k = 0; k < values.size(); ++k)
            if (columns[k] >= 0)
                values[k] = number(cells[static_cast<std::size_t>(columns[k])], column_names[k], file, line);
        if (!(values[3] > 0)) reject(file, line, fmt::format("column 'radius': {} must be greater than 0", values[3]));
        state.positions.push_back(triple(values, 0));
        state.radii.push_back(values[3]);
        state.velocities.push_back(columns[4] >= 0 ? triple(values, 4) : group.velocity);
        state.angular_velocities.push_back(columns[7] >= 0 ? triple(values, 7) : group.angular_velocity);
    }
}

}  // namespace grainray::scene
