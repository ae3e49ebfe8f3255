// Spheres in a box, found by place. Every size class has cells of its own, so that specks between boulders stay cheap.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "grainray/core.hpp"

namespace grainray::scene {

class SphereGrid {
public:
    /// wraps: the box repeats itself along these axes. capacity: number of spheres expected.
    SphereGrid(const Box&, std::array<bool, 3> wraps, double largest, std::size_t capacity);
    /// Whether a sphere would overlap one that is there. No larger than any inserted before: see insert().
    bool overlaps(const Vec3d& centre, double radius) const;
    /// Spheres must come largest first.
    void insert(const Vec3d& centre, double radius);

private:
    struct Sphere {
        Vec3d centre;
        double radius;
        std::int64_t next;  ///< in the same bucket; -1: the last
    };
    struct Level {
        double reach;  ///< no sphere of the level is larger
        std::array<std::int64_t, 3> cells;
        Vec3d cell;  ///< edges
    };
    Level make_level(std::size_t index) const;
    std::size_t level_of(double radius) const;
    std::size_t bucket(std::size_t level, std::int64_t x, std::int64_t y, std::int64_t z) const;
    bool bucket_overlaps(std::size_t bucket, const Vec3d& centre, double radius) const;
    bool level_overlaps(std::size_t level, const Vec3d& centre, double radius) const;

    Box box_;
    Vec3d extent_;
    std::array<bool, 3> wraps_;
    double largest_;
    std::vector<Level> levels_;
    std::vector<Sphere> spheres_;
    std::vector<std::int64_t> first_;  ///< of each bucket; -1: empty
};

}  // namespace grainray::scene
