// A grid of cells that wraps around: cell c of an axis is kept in bucket c mod m. A compact cloud gets a bucket a cell;
// in a sparse world far-apart cells share buckets, which costs a few tests that fail and never an answer. So memory
// follows the number of points, however far one of them may fly.
#pragma once

#include "neighbors/pair_test.hpp"

namespace grainray::neighbors {

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
        const float c = floorf((x - lower) * inverse_width);
        return static_cast<std::int32_t>(c < -most ? -most : c > most ? most : c);
    }
    GR_HD std::int32_t bucket(std::int32_t c) const {
        const auto turns = static_cast<std::int32_t>(floorf(static_cast<float>(c) * inverse_buckets));
        std::int32_t r = c - turns * buckets;  // off by a turn or more where the product was rounded
        while (r < 0) r += buckets;
        while (r >= buckets) r -= buckets;
        return r;
    }
    /// At most the distance of x from cell c.
    GR_HD float distance(float x, std::int32_t c) const {
        const float face = lower + static_cast<float>(c) * width, out = fmaxf(face - x, x - (face + width));
        return fmaxf(0.0f, out - (blur + 4e-7f * fabsf(x)));
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
    /// Buckets that are neighbours along x form one run, as long as the sphere is wide there.
    template <class Visit>
    GR_HD void for_each_run(const Sphere& s, float w, const Visit& visit) const {
        const float pad = w * 1.000001f + 1e-37f;  // the predicate's own rounding
        const bool round = pad > 1e-15f && pad < 1e15f;  // where squares keep their digits
        const AxisRange ry(y, s.y, pad), rz(z, s.z, pad);
        std::int32_t bz = z.bucket(rz.first);
        for (std::int32_t k = 0; k < rz.count; ++k, bz = bz + 1 == z.buckets ? 0 : bz + 1) {
            const float dz = rz.all ? 0.0f : z.distance(s.z, rz.first + k);
            std::int32_t by = y.bucket(ry.first);
            for (std::int32_t j = 0; j < ry.count; ++j, by = by + 1 == y.buckets ? 0 : by + 1) {
                const float dy = ry.all ? 0.0f : y.distance(s.y, ry.first + j);
                const float left = 1.000001f * (pad * pad) - (dy * dy + dz * dz);
                if (round && left < 0) continue;
                const AxisRange rx(x, s.x, round ? fminf(sqrtf(left) * 1.000001f, pad) : pad);
                const std::int32_t bx = x.bucket(rx.first), head = rx.count < x.buckets - bx ? rx.count : x.buckets - bx;
                const std::uint32_t start = row(by, bz);
                visit(start + bx, start + bx + head);
                if (head < rx.count) visit(start, start + rx.count - head);
            }
        }
    }
};

/// Cells about 2 mean reaches wide, at most about two buckets a point.
Grid make_grid(std::size_t points, float mean_reach, const Vec3f& lower, const Vec3f& upper, const Vec3f& box_lower, const Vec3f& period);

}  // namespace grainray::neighbors
