// Outlines in the map: inside or outside, by counting crossings, so that holes and several pieces work.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "grainray/core.hpp"

namespace grainray::scene {

struct Point2 {
    double x, y;
};
struct Polygon {
    std::vector<std::vector<Point2>> rings;
    bool contains(double x, double y) const;
    Point2 lower() const;
    Point2 upper() const;
};

/// CSV with the columns x and y (one ring), or GeoJSON (every Polygon and MultiPolygon in it). Throws InputError that begins
/// with `place`.
Polygon read_polygon(const std::filesystem::path&, const std::string& place);

}  // namespace grainray::scene
