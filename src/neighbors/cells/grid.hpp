// A grid of cells that wraps around: cell c of an axis is kept in bucket c mod m. A compact cloud gets a bucket a cell;
// in a sparse world far-apart cells share buckets, which costs a few tests that fail and never an answer. So memory
// follows the number of points, however far one of them may fly.
#pragma once

#include "neighbors/pair_test.hpp"

namespace grainray::neighbors {

/// floorf() of |v| < 2^31 and the larger of two without a call, which is what they are on the plainest x86-64.
GR_HD inline std::int32_t floor_of(float v) {
    const auto truncated = static_cast<std::int32_t>(v);
    return truncated - (static_cast<float>(truncated) > v);
}
GR_HD inline float larger(float a, float b) { return a > b ? a : b; }
GR_HD inline float smaller(float a, float b) { return a < b ? a : b; }

struct GridAxis {
    float lower, inverse_width;
    std::int32_t buckets;  ///< where periodic, the number of cells along the axis
    float inverse_buckets;
    bool periodic;
    float slack;           ///< what rounding may put between a point and its image, m; 0 where not periodic
    float width, blur;     ///< of a cell, and what rounding may move its faces by, m

    /// Cell of a coordinate. Every operation is monotonic, rounding included, so that an interval of coordinates is an
    /// interval of cells.
    GR_HD std::int32_t cell(float x) const {
        constexpr float most = 1 << 29;  // so that differences fit
        const float c = (x - lower) * inverse_width;
        return floor_of(c < -most ? -most : c > most ? most : c);
    }
    GR_HD std::int32_t bucket(std::int32_t c) const {
        const auto turns = floor_of(static_cast<float>(c) * inverse_buckets);
        std::int32_t r = c - turns * buckets;  // off by a turn or more where the product was rounded
        while (r < 0) r += buckets;
        while (r >= buckets) r -= buckets;
        return r;
    }
    /// At most the distance of x from cell c.
    GR_HD float distance(float x, std::int32_t c) const {
        const float face = lower + static_cast<float>(c) * width, out = larger(face - x, x - (face + width));
        return larger(0.0f, out - (blur + 4e-7f * fabsf(x)));
    }
};

/// The cells of one axis that a query meets.
struct AxisRange {
    std::int32_t first, count;
    bool all;  ///< every bucket, some for several cells
    GR_HD AxisRange(const GridAxis& a, float x, float w)
        : first(a.cell(x - (w + a.slack))) {
        const std::int32_t last = a.cell(x + (w + a.slack));
        all = last - first >= a.buckets;
        count = all ? a.buckets : last - first + 1;
    }
};

struct Grid {
    GridAxis x, y, z;

    GR_HD std::uint32_t row(std::int32_t by, std::int32_t bz) const {
        return static_cast<std::uint32_t>((bz * y.buckets + by) * x.buckets);
    }
    GR_HD std::uint32_t bucket(const Sphere& s) const {
        return row(y.bucket(y.cell(s.y)), z.bucket(z.cell(s.z))) + static_cast<std::uint32_t>(x.bucket(x.cell(s.x)));
    }
    std::uint32_t buckets() const { return static_cast<std::uint32_t>(x.buckets) * y.buckets * z.buckets; }

    /// Calls visit(first, last) for runs of buckets that together hold every point nearer to s than `w`; no bucket twice.
    /// Buckets that are neighbours along x form one run. `cut`: runs are only as long as the sphere is wide there, which
    /// pays where reading a point costs more than a guess that fails.
    template <bool cut, class Visit>
    GR_HD void for_each_run(const Sphere& s, float w, const Visit& visit) const {
        const Rows<cut> rows(*this, s, w);
        std::int32_t bz = z.bucket(rows.z.first);
        for (std::int32_t k = 0; k < rows.z.count; ++k, bz = bz + 1 == z.buckets ? 0 : bz + 1) {
            const float left = rows.left_of_layer(k);
            std::int32_t by = y.bucket(rows.y.first);
            for (std::int32_t j = 0; j < rows.y.count; ++j, by = by + 1 == y.buckets ? 0 : by + 1) rows.visit(rows.left_of_row(left, j), by, bz, visit);
        }
    }
    /// Every `shares`-th row of them, from row `share` on: what one of several threads looks at.
    template <bool cut, class Visit>
    GR_HD void for_each_run(const Sphere& s, float w, std::uint32_t share, std::uint32_t shares, const Visit& visit) const {
        const Rows<cut> rows(*this, s, w);
        const std::int32_t first_y = y.bucket(rows.y.first), first_z = z.bucket(rows.z.first);
        const auto count_y = static_cast<std::uint32_t>(rows.y.count), all = count_y * static_cast<std::uint32_t>(rows.z.count);
        for (std::uint32_t r = share; r < all; r += shares) {
            const auto j = static_cast<std::int32_t>(r % count_y), k = static_cast<std::int32_t>(r / count_y);
            const std::int32_t by = first_y + j, bz = first_z + k;
            rows.visit(rows.left_of_row(rows.left_of_layer(k), j), by < y.buckets ? by : by - y.buckets, bz < z.buckets ? bz : bz - z.buckets, visit);
        }
    }

private:
    /// The rows of buckets along x that a query meets.
    template <bool cut>
    struct Rows {
        const Grid& grid;
        Sphere s;
        float pad;   ///< with the predicate's own rounding
        bool round;  ///< the runs are cut; only where squares keep their digits
        AxisRange x, y, z;
        std::int32_t first_x;

        GR_HD Rows(const Grid& g, const Sphere& sphere, float w)
            : grid(g), s(sphere), pad(w * 1.000001f + 1e-37f), round(cut && pad > 1e-15f && pad < 1e15f), x(g.x, s.x, pad), y(g.y, s.y, pad), z(g.z, s.z, pad),
              first_x(g.x.bucket(x.first)) {}

        /// Square of half the width that the sphere has in layer k, at least, and in row j of a layer; negative: none.
        GR_HD float left_of_layer(std::int32_t k) const { return 1.000001f * (pad * pad) - squared_distance(grid.z, z, s.z, k); }
        GR_HD float left_of_row(float left, std::int32_t j) const { return left - squared_distance(grid.y, y, s.y, j); }
        GR_HD static float squared_distance(const GridAxis& axis, const AxisRange& range, float at, std::int32_t k) {
            if (!cut || range.all) return 0;
            const float d = axis.distance(at, range.first + k);
            return d * d;
        }

        template <class Visit>
        GR_HD void visit(float left, std::int32_t by, std::int32_t bz, const Visit& visit_run) const {
            std::int32_t first = first_x, count = x.count;
            if (round) {
                if (left < 0) return;
                if (!x.all) {  // cells are counted from the whole run's first, which has been brought into the axis
                    const AxisRange run(grid.x, s.x, smaller(sqrtf(left) * 1.000001f, pad));
                    first += run.first - x.first;
                    if (first >= grid.x.buckets) first -= grid.x.buckets;
                    count = run.count;
                }
            }
            // Past the end of the axis a run goes on from its start.
            const std::int32_t room = grid.x.buckets - first, head = count < room ? count : room;
            const std::uint32_t start = grid.row(by, bz);
            visit_run(start + first, start + first + head);
            if (head < count) visit_run(start, start + (count - head));
        }
    };
};

/// Cells about 2 mean reaches wide, along x down to 1 / `cut_x` (a power of 2) of that where the buckets, about two a point, suffice.
Grid make_grid(std::size_t points, float mean_reach, const Vec3f& lower, const Vec3f& upper, const Vec3f& box_lower, const Vec3f& period, int cut_x);

/// Of a search. Along x, where runs lie, narrow cells cost no more rows and spare a query a quarter of its points.
inline constexpr int search_cut_x = 4;

}  // namespace grainray::neighbors
