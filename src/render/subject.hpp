// What the picture is of: the frame's particles as spheres near a local zero, so that floats are fine for the rest.
#pragma once

#include <optional>
#include <vector>

#include "grainray/output.hpp"
#include "grainray/scene.hpp"

namespace grainray::picture {

struct Sphere {  // four floats in a row: the layout Embree reads
    Vec3f centre;
    float radius = 0;
};

/// Everything here but `origin` is relative to `origin`.
struct Subject {
    Vec3d origin;                      ///< world position of the local zero
    Box bounds;                        ///< of all particles but a few runaways, and of meshes that are not much larger
    std::vector<Sphere> spheres;
    std::vector<std::uint32_t> index;  ///< frame index of each sphere: particles that are not finite are left out
    double diagonal() const { return length(bounds.extent()); }
};

/// `meshes`: where the scene's meshes are, in the world. Throws InputError: no radii, fields of different lengths.
Subject make_subject(const Frame&, const Scene&, const std::optional<Box>& meshes);
/// The frame's particles, seen as `other` is: with its origin and bounds.
Subject make_subject_like(const Subject& other, const Frame&);

/// Makes a box hold another one too.
void grow(Box&, const Box& by);

/// The value below which a share q of the values lies; reorders them. They must not be empty.
double percentile(std::vector<double>& values, double q);

}  // namespace grainray::picture
