// CSV files: a header line, then rows of numbers. Empty lines and lines that begin with # are skipped.
#pragma once

#include <filesystem>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

#include "scene/value.hpp"

namespace grainray::scene {

/// Throws InputError "file:line: why".
[[noreturn]] void reject_row(const std::string& file, std::size_t line, const std::string& why);
/// Cells without blanks and quotes around them; they point into `row`.
std::vector<std::string_view> split_row(std::string_view row);
/// The next row that is neither empty nor a comment; false at the end.
bool next_csv_row(std::istream&, std::string& row, std::size_t& line);
/// A finite number.
double csv_number(std::string_view cell, std::string_view column, const std::string& file, std::size_t line);

struct CsvTable {
    std::vector<std::vector<double>> rows;  ///< the columns asked for, in that order
    std::vector<std::size_t> lines;         ///< of each row in the file
};
/// Throws InputError; `key` is the key of the scene that names the file.
CsvTable read_csv_table(const std::filesystem::path&, const Node& key, const std::vector<std::string_view>& columns);

}  // namespace grainray::scene
