// Snapshots side by side on one page.
#pragma once

#include "render/canvas.hpp"
#include "render/view.hpp"

namespace grainray::picture {

/// Where a snapshot stands on its page, pixels.
struct Cell {
    int x, y, width, height;
};

/// Of `count` snapshots the k-th, row by row, all of one size; the page keeps room for a legend on the right.
Cell cell_of(const Canvas& page, std::size_t count, std::size_t k);

inline constexpr Margins cell_margins{0.03, 0.03, 0.09, 0.04};

/// Copies the snapshot into its cell, which is as large, with its time above it.
void place(Canvas& page, const Cell&, const Canvas& snapshot, double time);

}  // namespace grainray::picture
