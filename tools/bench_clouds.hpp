// Clouds of points for timing the neighbour search. Whatever the sizes, a point has about ten neighbours.
#pragma once

#include <string>
#include <vector>

#include "grainray/neighbors.hpp"

namespace grainray::cli {

struct Cloud {
    std::string name;
    double ratio = 1;          ///< of the largest reach to the smallest
    std::string order;         ///< of the points in memory: morton (as a simulation keeps them) or random
    std::vector<float> xyz;    ///< packed x y z
    std::vector<float> reach;  ///< one a point

    std::size_t size() const { return reach.size(); }
};

/// random     uniform in a cube, one reach
/// lattice    cubic, each point moved by up to 0.3 of the spacing, one reach
/// lognormal  uniform in a cube, reaches log-normal, cut at two standard deviations, which are `ratio` apart
/// two-size   uniform in a cube, two reaches in equal volumes
/// sparse     64 cubes that fill 1 % of a cube of 3 km, one reach
/// clustered  64 Gaussian clusters, their densities up to 64 times apart, one reach
const std::vector<std::string>& cloud_names();

/// Whether a cloud is made for several ratios of its reaches.
bool has_sizes(const std::string& cloud);

/// The same arguments give the same points. Throws InputError for a name that is not known or a ratio below 1.
Cloud make_cloud(const std::string& name, double ratio, std::size_t points, const std::string& order);

/// The points after a short while: each has moved by up to 0.05 of its reach along each axis.
std::vector<float> moved_xyz(const Cloud&);

/// The cloud's points where `xyz` and `reach` are copies of the cloud's arrays, on any device.
Points points_of(const Array<float>& xyz, const Array<float>& reach);

}  // namespace grainray::cli
