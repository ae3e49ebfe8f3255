// Elevation grids: ESRI ASCII here, every other format through GDAL where this build has it.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "grainray/output.hpp"
#include "output/files.hpp"
#include "surfaces/grid_gdal.hpp"
#include "surfaces/surfaces.hpp"

namespace grainray::surfaces {
namespace {

/// Words of a text, one after the other.
class Words {
public:
    explicit Words(std::string_view text) : rest_(text) {}
    std::string_view next() {
        const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
        while (!rest_.empty() && blank(rest_.front())) line_ += rest_.front() == '\n', rest_.remove_prefix(1);
        std::size_t size = 0;
        while (size < rest_.size() && !blank(rest_[size])) ++size;
        const auto word = rest_.substr(0, size);
        rest_.remove_prefix(size);
        return word;
    }
    std::size_t line() const { return line_; }

private:
    std::string_view rest_;
    std::size_t line_ = 1;
};

struct Header {
    std::optional<double> columns, rows, corner_x, corner_y, centre_x, centre_y, cell, dx, dy, hole;

    std::optional<double>* find(std::string word) {
        std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        const std::pair<const char*, std::optional<double>*> known[] = {
            {"ncols", &columns},     {"nrows", &rows},  {"xllcorner", &corner_x}, {"yllcorner", &corner_y}, {"xllcenter", &centre_x},
            {"yllcenter", &centre_y}, {"cellsize", &cell}, {"dx", &dx},           {"dy", &dy},              {"nodata_value", &hole}};
        for (const auto& [name, value] : known)
            if (word == name) return value;
        return nullptr;
    }
};

class EsriGrid {
public:
    EsriGrid(std::string_view text, std::string file, std::string place) : words_(text), file_(std::move(file)), place_(std::move(place)) {}

    ElevationGrid read() {
        std::string_view word = words_.next();
        for (std::optional<double>* value; (value = header_.find(std::string(word))); word = words_.next()) *value = number(words_.next(), std::string(word));
        ElevationGrid g = frame();
        g.heights.resize(static_cast<std::size_t>(g.columns * g.rows));
        for (std::int64_t row = g.rows; row-- > 0;)
            for (std::int64_t i = 0; i < g.columns; ++i, word = words_.next()) {
                if (word.empty())
                    reject(fmt::format("ends after {} of {} rows; the file is cut off, or nrows and ncols are wrong", g.rows - 1 - row, g.rows));
                const double h = number(word, "height");
                g.heights[static_cast<std::size_t>(row * g.columns + i)] = header_.hole && h == *header_.hole ? NAN : h;
            }
        if (!word.empty()) reject("has more heights than ncols x nrows; correct its header");
        return g;
    }

private:
    [[noreturn]] void reject(const std::string& why) const { throw InputError(fmt::format("{}{}:{}: {}", place_, file_, words_.line(), why)); }

    double number(std::string_view word, const std::string& what) const {
        double value = 0;
        if (word.starts_with('+')) word.remove_prefix(1);
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc{} || end != word.data() + word.size())
            reject(fmt::format("{} '{}' is not a number{}", what, word, word.find(',') != word.npos ? "; write decimals with a point" : ""));
        return value;
    }

    ElevationGrid frame() const {
        const auto need = [&](const std::optional<double>& value, const char* name) {
            if (!value) reject(fmt::format("the header has no '{}'; an ESRI ASCII grid begins with ncols, nrows, xllcorner, yllcorner, cellsize, NODATA_value", name));
            return *value;
        };
        const double columns = need(header_.columns, "ncols"), rows = need(header_.rows, "nrows");
        for (const double n : {columns, rows})
            if (!(n >= 2 && n <= 1e6 && n == std::floor(n))) reject(fmt::format("{} columns by {} rows: both must be whole numbers from 2 to 1000000", columns, rows));
        ElevationGrid g;
        g.columns = static_cast<std::int64_t>(columns);
        g.rows = static_cast<std::int64_t>(rows);
        g.dx = header_.dx ? *header_.dx : need(header_.cell, "cellsize");
        g.dy = header_.dy ? *header_.dy : need(header_.cell, "cellsize");
        if (!(g.dx > 0 && g.dy > 0 && std::isfinite(g.dx) && std::isfinite(g.dy))) reject(fmt::format("cells of {} x {} m; they must be larger than 0", g.dx, g.dy));
        g.x = header_.centre_x ? *header_.centre_x : need(header_.corner_x, "xllcorner") + 0.5 * g.dx;
        g.y = header_.centre_y ? *header_.centre_y : need(header_.corner_y, "yllcorner") + 0.5 * g.dy;
        return g;
    }

    Words words_;
    std::string file_, place_;
    Header header_;
};

bool looks_like_esri(std::string_view text) {
    Header header;
    return header.find(std::string(Words(text.substr(0, 200)).next())) != nullptr;
}

void check_heights(const ElevationGrid& g, const std::string& place) {
    std::size_t holes = 0;
    for (std::size_t k = 0; k < g.heights.size(); ++k) {
        holes += std::isnan(g.heights[k]);
        if (std::isnan(g.heights[k]) || std::fabs(g.heights[k]) < 1e5) continue;
        const auto n = static_cast<std::int64_t>(k);
        throw InputError(fmt::format("{}the height at column {}, row {} from the north is {} m, which no ground is; mark holes by NODATA_value", place, n % g.columns + 1,
                                     g.rows - n / g.columns, g.heights[k]));
    }
    if (holes == g.heights.size()) throw InputError(place + "every node is a hole; give a grid with heights");
}

}  // namespace

ElevationGrid read_grid_file(const std::filesystem::path& path, const std::string& place) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        throw InputError(fmt::format("{}{} is not there or no file; give a path relative to the scene file", place, path.string()));
    const std::string text = read_text(path);
    ElevationGrid g = looks_like_esri(text) ? EsriGrid(text, path.string(), place).read() : read_with_gdal(path, place);
    check_heights(g, place);
    return g;
}

void write_esri_grid(const std::filesystem::path& path, const ElevationGrid& g) {
    std::string out = fmt::format("ncols {}\nnrows {}\nxllcorner {}\nyllcorner {}\n", g.columns, g.rows, g.x - 0.5 * g.dx, g.y - 0.5 * g.dy);
    out += g.dx == g.dy ? fmt::format("cellsize {}\n", g.dx) : fmt::format("dx {}\ndy {}\n", g.dx, g.dy);
    out += "NODATA_value -9999\n";
    for (std::int64_t row = g.rows; row-- > 0;)
        for (std::int64_t i = 0; i < g.columns; ++i) {
            const double h = g.at(i, row);
            out += fmt::format("{:.6f}{}", std::isnan(h) ? -9999.0 : h, i + 1 == g.columns ? '\n' : ' ');
        }
    write_text_atomically(path, out);
}

}  // namespace grainray::surfaces
