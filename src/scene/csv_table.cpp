// Reading CSV: rows, cells, numbers, and tables of named columns.
#include "scene/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include "scene/suggest.hpp"

namespace grainray::scene {

void reject_row(const std::string& file, std::size_t line, const std::string& why) {
    throw InputError(fmt::format("{}:{}: {}", file, line, why));
}

std::vector<std::string_view> split_row(std::string_view row) {
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
bool next_csv_row(std::istream& in, std::string& row, std::size_t& line) {
    while (std::getline(in, row)) {
        if (++line == 1 && row.starts_with("\xef\xbb\xbf")) row.erase(0, 3);  // byte order mark
        if (!row.empty() && row.back() == '\r') row.pop_back();
        const auto first = row.find_first_not_of(" \t");
        if (first != std::string::npos && row[first] != '#') return true;
    }
    return false;
}

double csv_number(std::string_view cell, std::string_view column, const std::string& file, std::size_t line) {
    double value = 0;
    if (cell.starts_with('+')) cell.remove_prefix(1);
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc{} || end != cell.data() + cell.size())
        reject_row(file, line, fmt::format("column '{}': '{}' is not a number", column, cell));
    if (!std::isfinite(value)) reject_row(file, line, fmt::format("column '{}': {} is not a finite number", column, value));
    return value;
}

CsvTable read_csv_table(const std::filesystem::path& path, const Node& key, const std::vector<std::string_view>& names) {
    const std::string file = path.string();
    std::ifstream in(path);
    std::error_code ignored;
    if (!in || std::filesystem::is_directory(path, ignored)) fail(key, fmt::format("{} cannot be read; give a CSV file, relative to the scene file", file));
    std::string row;
    std::size_t line = 0;
    if (!next_csv_row(in, row, line)) reject_row(file, 1, fmt::format("is empty; expected a header such as {}", join(names)));
    const auto header = split_row(row);
    std::vector<std::size_t> places;
    for (const auto name : names) {
        const auto found = std::find(header.begin(), header.end(), name);
        if (found == header.end()) reject_row(file, line, fmt::format("the header has no column '{}'{} Needed: {}", name, did_you_mean(name, header), join(names)));
        places.push_back(static_cast<std::size_t>(found - header.begin()));
    }
    const std::size_t width = header.size();
    CsvTable table;
    while (next_csv_row(in, row, line)) {
        const auto cells = split_row(row);
        if (cells.size() != width) reject_row(file, line, fmt::format("has {} values, the header has {} columns", cells.size(), width));
        std::vector<double>& values = table.rows.emplace_back();
        for (std::size_t k = 0; k < names.size(); ++k) values.push_back(csv_number(cells[places[k]], names[k], file, line));
        table.lines.push_back(line);
    }
    return table;
}

}  // namespace grainray::scene
