// Figures of a deposit, as benchmarks/peers/common/deposit.py defines them: equal spheres of radius r in a channel of width W
// from the wall x = 0; h_top the highest sphere top and h_mass the height of the mass at solid fraction 0.6, in bins of 2 r.
#pragma once

#include <vector>

#include "grainray/core.hpp"

namespace grainray::validation {

struct Channel {
    double radius, width, length;  ///< of a sphere, of the channel, of the column at the start, m
};

struct Profile {
    std::vector<double> x, top, mass;  ///< middle of the bin, the two heights
};
Profile profile(const std::vector<Vec3d>& centres, const Channel&);

/// Angles in degrees; NaN where fewer than 3 points make a line.
struct Deposit {
    double x_edge;         ///< where the smoothed h_mass falls below 4 r: the end of the contiguous bed
    double x_toe;          ///< the same at 2 r
    double x_50, x_95, x_99, x_max, z_mean;
    double h_wall;         ///< mean h_top over the first five bins
    double angle_secant;   ///< atan(h_wall / x_edge), degrees
    double angle_top, r2_top;    ///< line through h_top from 20 to 80 % of its greatest value, behind the place of that
    double angle_mass, r2_mass;  ///< the same with h_mass
    double angle_steep;    ///< the steepest line over 0.4 of the column's length
};
Deposit measure(const std::vector<Vec3d>& centres, const Channel&);

}  // namespace grainray::validation
