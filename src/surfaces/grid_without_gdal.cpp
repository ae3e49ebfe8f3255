#include <fmt/format.h>

#include "surfaces/grid_gdal.hpp"

namespace grainray::surfaces {

ElevationGrid read_with_gdal(const std::filesystem::path& path, const std::string& place) {
    throw InputError(fmt::format("{}it is not an ESRI ASCII grid, and this build has no GDAL to read other formats; install libgdal-dev and build again, or convert it: "
                                 "gdal_translate -of AAIGrid {} {}", place, path.string(), path.stem().string() + ".asc"));
}

}  // namespace grainray::surfaces
