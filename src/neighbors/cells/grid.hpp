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

/// Their buckets: `head` from the first on and, past the end of the axis, `tail` from 0 on.
struct BucketRun {
    std::int32_t first, head, tail;
    GR_HD BucketRun(const GridAxis& a, float x, float w) {
        const AxisRange cells(a, x, w);
        first = a.bucket(cells.first);
        head = cells.count < a.buckets - first ? cells.count : a.buckets - first;
        tail = cells.count - head;
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
        const float pad = w * 1.000001f + 1e-37f;  // the predicate's own rounding
        const bool round = cut && pad > 1e-15f && pad < 1e15f;  // where squares keep their digits
        const AxisRange ry(y, s.y, pad), rz(z, s.z, pad);
        const BucketRun whole(x, s.x, pad);
        std::int32_t bz = z.bucket(rz.first);
        for (std::int32_t k = 0; k < rz.count; ++k, bz = bz + 1 == z.buckets ? 0 : bz + 1) {
            const float dz = !cut || rz.all ? 0.0f : z.distance(s.z, rz.first + k);
            std::int32_t by = y.bucket(ry.first);
            for (std::int32_t j = 0; j < ry.count; ++j, by = by + 1 == y.buckets ? 0 : by + 1) {
                const float dy = !cut || ry.all ? 0.0f : y.distance(s.y, ry.first + j);
                const float left = 1.000001f * (pad * pad) - (dy * dy + dz * dz);
                if (round && left < 0) continue;
                const BucketRun run = round ? BucketRun(x, s.x, smaller(sqrtf(left) * 1.000001f, pad)) : whole;
                const std::uint32_t start = row(by, bz);
                visit(start + run.first, start + run.first + run.head);
                if (run.tail) visit(start, start + run.tail);
            }
        }
    }
};

/// Cells about 2 mean reaches wide, at most about two buckets a point.
Grid make_grid(std::size_t points, float mean_reach, const Vec3f& lower, const Vec3f& upper, const Vec3f& box_lower, const Vec3f& period);

}  // namespace grainray::neighbors
