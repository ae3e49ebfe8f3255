// Grids through GDAL, which is optional: grid_gdal.cpp or grid_without_gdal.cpp is built.
#pragma once

#include "surfaces/surfaces.hpp"

namespace grainray::surfaces {

/// First band of a raster. Throws InputError that begins with `place`, also where this build has no GDAL.
ElevationGrid read_with_gdal(const std::filesystem::path&, const std::string& place);

}  // namespace grainray::surfaces
