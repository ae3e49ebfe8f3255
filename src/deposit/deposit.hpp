// Where grains lie on the ground: maps of depth and speed, profiles along the flow, run-out.
#pragma once

#include <vector>

#include "grainray/output.hpp"
#include "grainray/surfaces.hpp"

namespace grainray::deposit {

/// Values at the nodes of a grid; each stands for the cell about its node.
struct Maps {
    ElevationGrid depth;  ///< solid volume over cell area and solid fraction, m; 0 without grains, NaN without ground
    ElevationGrid top;    ///< how high the highest grain reaches above the ground below it, m; 0 and NaN as before
    ElevationGrid speed;  ///< mean speed of the grains, weighted by volume, m/s; NaN without grains
    double volume = 0;    ///< solid, of the grains on the ground, m3
    double beyond = 0;    ///< solid, beyond the grid or over holes: on no map, m3
};

/// Cells of another size that cover the same ground; their heights are those of the ground. Throws InputError (cells
/// too many or larger than the grid).
ElevationGrid cells_of_size(const ElevationGrid& ground, double size);

/// A grain is shared among the cells below it by volume. `cells` gives the nodes. Throws InputError: the frame has no
/// radii or no velocities, the solid fraction is none.
Maps map(const Frame&, const ElevationGrid& ground, const ElevationGrid& cells, double solid_fraction);

/// A straight line on the map along which distances are measured.
struct Axis {
    double x = 0, y = 0;    ///< where the distance is 0, m
    double dx = 1, dy = 0;  ///< unit vector
    double along(double px, double py) const { return (px - x) * dx + (py - y) * dy; }
};

/// From the rear of the grains at the start (1 % of their volume lies behind) in the direction in which their centre of
/// mass has moved. Throws InputError where it has not moved on the map.
Axis flow_axis(const Frame& start, const Frame& now);
/// The same line for a direction that is given. Throws InputError where it is none.
Axis flow_axis(const Frame& start, double dx, double dy);

/// Cells whose distance along the axis is within one bin.
struct ProfileRow {
    double distance;  ///< of the middle of the bin, m
    double ground;    ///< mean height of the ground below the grains, m
    double depth;     ///< mean over the cells that hold grains, m
    double deepest;   ///< m
    double width;     ///< area of the cells that hold grains over the length of the bin, m
    double speed;     ///< mean, weighted by volume, m/s
};
/// From the first bin with grains to the last; bins between that hold none are zero.
std::vector<ProfileRow> profile(const Maps&, const ElevationGrid& cells, const Axis&, double bin);

struct Runout {
    double front;        ///< distance that 99 % of the volume is behind, m
    double front_95;     ///< 95 %, m
    double farthest;     ///< of the farthest grain, m
    double x, y;         ///< mean place of the grains beyond `front`: the front on the map, m
    double fall;         ///< from the mean height of the rearmost 1 % at the start to that of the foremost 1 % now, m
    double reach_angle;  ///< atan(fall / front), degrees
    double centre_travel, centre_fall;  ///< of the centre of mass, along the axis and downwards, m
};
Runout runout(const Frame& start, const Frame& now, const Axis&);

}  // namespace grainray::deposit
