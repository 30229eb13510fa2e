#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <glm/vec2.hpp>

#include "core/base/words.h"

/// GDAL as map files need it. Only `.cpp` files of the import include this.
namespace lumorph::navigation {

using Dataset = std::unique_ptr<GDALDataset>;

/// GDAL for the time of one import, in one thread: it knows the drivers of map files alone, reaches no network whatever
/// a file names, runs no code of a file, and prints nothing.
class GdalForFiles {
public:
    GdalForFiles();
    ~GdalForFiles();
    GdalForFiles(const GdalForFiles&) = delete;
    GdalForFiles& operator=(const GdalForFiles&) = delete;
};

/// What GDAL said last.
[[nodiscard]] Words gdalWords();

/// A file as a raster; null where no driver for its kind reads it. A virtual raster (VRT), which names other files, is
/// read under its own ending only.
[[nodiscard]] Dataset openRaster(const std::filesystem::path& file);
/// A file as outlines, lines and points; null as above.
[[nodiscard]] Dataset openOutlines(const std::filesystem::path& file);

/// Reference systems have east or longitude first, as files write them.
[[nodiscard]] OGRSpatialReference systemOf(int epsg);
[[nodiscard]] OGRSpatialReference systemOf(const std::string& projection);
/// Without its heights.
[[nodiscard]] OGRSpatialReference levelSystem(const OGRSpatialReference& system);
using Transformation = std::unique_ptr<OGRCoordinateTransformation>;
[[nodiscard]] Transformation transformation(const OGRSpatialReference& from, const OGRSpatialReference& to);
/// Longitude and latitude, degrees, of a point of another system; nothing where there are none.
[[nodiscard]] std::optional<glm::dvec2> lonLatOf(const OGRSpatialReference& system, glm::dvec2 point);
/// A vertical unit by its name (`ft`, `US survey foot`), in metres; nothing for one that measures no length.
[[nodiscard]] std::optional<double> metresOfUnit(const std::string& unit);

} // namespace lumorph::navigation
