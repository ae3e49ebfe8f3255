// A grid of cells that wraps around: cell c of an axis is kept in bucket c mod m. A compact cloud gets a bucket a cell;
// in a sparse world far-apart cells share buckets, which costs a few tests that fail and never an answer. So memory
// follows the number of points, however far one of them may fly.
#pragma once

#include "neighbors/pair_test.hpp"

namespace grainray::neighbors {

struct GridAxis {
    double lower, inverse_width;
    std::int32_t buckets;  ///< a power of two, or, where periodic, the number of cells along the axis
    bool periodic;

    /// Cell of a coordinate; monotonic, so that an interval of coordinates is an interval of cells.
    GR_HD std::int64_t cell(double x) const {
        const double c = (x - lower) * inverse_width, held = c < -1e18 ? -1e18 : c > 1e18 ? 1e18 : c;
        const auto truncated = static_cast<std::int64_t>(held);
        return truncated - (static_cast<double>(truncated) > held);  // floor, without a call
    }
    GR_HD std::int32_t bucket(std::int64_t c) const {
        if (!periodic) return static_cast<std::int32_t>(c & (buckets - 1));
        const std::int64_t r = c % buckets;
        return static_cast<std::int32_t>(r < 0 ? r + buckets : r);
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

    /// Calls visit(first, last) for runs of buckets that together hold every point within `w` of s along each axis;
    /// no bucket twice. Buckets that are neighbours along x form one run.
    template <class Visit>
    GR_HD void for_each_run(const Sphere& s, float w, const Visit& visit) const {
        const double pad = static_cast<double>(w) * 1.000001 + 1e-37;  // the predicate's own rounding
        const auto clip = [](std::int64_t n, std::int32_t most) { return n < most ? static_cast<std::int32_t>(n) : most; };
        const std::int64_t x0 = x.cell(s.x - pad), y0 = y.cell(s.y - pad), z0 = z.cell(s.z - pad);
        const std::int32_t nx = clip(x.cell(s.x + pad) - x0 + 1, x.buckets), ny = clip(y.cell(s.y + pad) - y0 + 1, y.buckets),
                           nz = clip(z.cell(s.z + pad) - z0 + 1, z.buckets);
        const std::int32_t bx = x.bucket(x0), head = nx < x.buckets - bx ? nx : x.buckets - bx;
        std::int32_t bz = z.bucket(z0);
        for (std::int32_t k = 0; k < nz; ++k, bz = bz + 1 == z.buckets ? 0 : bz + 1) {
            std::int32_t by = y.bucket(y0);
            for (std::int32_t j = 0; j < ny; ++j, by = by + 1 == y.buckets ? 0 : by + 1) {
                const std::uint32_t start = row(by, bz);
                visit(start + bx, start + bx + head);
                if (head < nx) visit(start, start + nx - head);
            }
        }
    }
};

/// Cells about 2 mean reaches wide, at most about two buckets a point.
Grid make_grid(std::size_t points, float mean_reach, const Vec3f& lower, const Vec3f& upper, const Vec3f& box_lower, const Vec3f& period);

}  // namespace grainray::neighbors
