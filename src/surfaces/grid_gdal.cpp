#include <gdal_priv.h>

#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "surfaces/grid_gdal.hpp"

namespace grainray::surfaces {

ElevationGrid read_with_gdal(const std::filesystem::path& path, const std::string& place) {
    GDALAllRegister();
    CPLPushErrorHandler(CPLQuietErrorHandler);  // the sentences below say it in the scene's terms
    const std::shared_ptr<void> quiet(nullptr, [](void*) { CPLPopErrorHandler(); });
    const std::unique_ptr<GDALDataset> data(GDALDataset::FromHandle(GDALOpenEx(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, nullptr, nullptr, nullptr)));
    if (!data || data->GetRasterCount() < 1)
        throw InputError(place + "it is neither an ESRI ASCII grid nor a raster that GDAL can read; give a grid of elevations");
    double t[6];
    if (data->GetGeoTransform(t) != CE_None) throw InputError(place + "the raster does not say where it lies; give it a geotransform (gdal_translate -a_ullr)");
    if (t[2] != 0 || t[4] != 0) throw InputError(place + "the raster is turned against the axes; resample it (gdalwarp)");
    ElevationGrid g;
    g.columns = data->GetRasterXSize();
    g.rows = data->GetRasterYSize();
    g.dx = std::fabs(t[1]);
    g.dy = std::fabs(t[5]);
    if (g.columns < 2 || g.rows < 2) throw InputError(place + "the raster has fewer than two nodes along an axis; give a larger one");
    g.x = (t[1] > 0 ? t[0] : t[0] + t[1] * static_cast<double>(g.columns)) + 0.5 * g.dx;
    g.y = (t[5] < 0 ? t[3] + t[5] * static_cast<double>(g.rows) : t[3]) + 0.5 * g.dy;
    std::vector<double> band(static_cast<std::size_t>(g.columns * g.rows));
    GDALRasterBand& heights = *data->GetRasterBand(1);
    const int columns = static_cast<int>(g.columns), rows = static_cast<int>(g.rows);
    if (heights.RasterIO(GF_Read, 0, 0, columns, rows, band.data(), columns, rows, GDT_Float64, 0, 0) != CE_None)
        throw InputError(place + "its heights cannot be read; the file may be cut off");
    int has_hole = 0;
    const double hole = heights.GetNoDataValue(&has_hole);
    g.heights.resize(band.size());
    for (std::int64_t j = 0; j < g.rows; ++j)
        for (std::int64_t i = 0; i < g.columns; ++i) {
            const std::int64_t row = t[5] < 0 ? g.rows - 1 - j : j, column = t[1] > 0 ? i : g.columns - 1 - i;
            const double h = band[static_cast<std::size_t>(row * g.columns + column)];
            g.heights[static_cast<std::size_t>(j * g.columns + i)] = has_hole && h == hole ? NAN : h;
        }
    return g;
}

}  // namespace grainray::surfaces
