#include "render/sheet.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "render/overlay.hpp"
#include "render/strokes.hpp"

namespace grainray::picture {

namespace {

constexpr double pleasant = 1.4;  // width over height of a snapshot
constexpr double legend = 0.12;   // share of the page's width

/// As many columns as make the snapshots most pleasant.
int columns_for(double width, double height, std::size_t count) {
    int best = 1;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t columns = 1; columns <= count; ++columns) {
        const std::size_t rows = (count + columns - 1) / columns;
        const double shape = width / static_cast<double>(columns) / (height / static_cast<double>(rows));
        const double penalty = std::abs(std::log(shape / pleasant)) + 0.1 * static_cast<double>(rows * columns - count);
        if (penalty < least) least = penalty, best = static_cast<int>(columns);
    }
    return best;
}

}  // namespace

Cell cell_of(const Canvas& page, std::size_t count, std::size_t k) {
    const int wide = static_cast<int>(page.width * (1 - legend));
    const int columns = columns_for(wide, page.height, count), rows = (static_cast<int>(count) + columns - 1) / columns;
    const int width = std::max(wide / columns, 1), height = std::max(page.height / rows, 1);
    return {static_cast<int>(k) % columns * width, static_cast<int>(k) / columns * height, width, height};
}

void place(Canvas& page, const Cell& cell, const Canvas& snapshot, double time) {
    for (int y = 0; y < cell.height; ++y)
        for (int x = 0; x < cell.width; ++x) page.color[page.at(cell.x + x, cell.y + y)] = snapshot.color[snapshot.at(x, y)];
    if (!has_text(page.width, page.height)) return;
    const float size = text_height(unit_of(page));
    Writing writing;
    writing.text(fmt::format("t = {:.4g} s", time), static_cast<float>(cell.x) + 1.2f * size, static_cast<float>(cell.y) + 2.2f * size, size);
    writing.print(page);
}

}  // namespace grainray::picture
