#pragma once

#include <array>
#include <optional>
#include <variant>

#include "app/applications/navigation/import_gdal.h"

namespace lumorph::navigation {

/// How the samples of a raster become metres.
struct HeightCode {
    enum class Colors {
        none,      ///< band 1 has them
        terrarium, ///< 256 R + G + B / 256 - 32768 (Mapzen's terrain tiles)
        terrainRgb ///< (65536 R + 256 G + B) / 10 - 10000 (Mapbox)
    };
    Colors colors = Colors::none;
    double scale = 1.0, offset = 0.0; ///< metres = scale * sample + offset
    Words note;                       ///< what is unusual about it; empty: nothing
};

/// How a raster has heights, or why it has none: a photo, a hillshade, another quantity. Several bands or eight bits
/// are heights only where the raster says so: by a unit of length, scale or offset, a vertical reference system or a
/// band's description, or where its colours make a steady surface in one of the codes above.
[[nodiscard]] std::variant<HeightCode, Words> heightCodeOf(GDALDataset& raster);

/// Where a raster lies.
struct RasterPlace {
    std::array<double, 6> transform{};                  ///< as GDAL has it
    OGRSpatialReference system = OGRSpatialReference(); ///< empty: metres that lie nowhere on Earth
};

/// The same as heights in metres, read from the raster when they are asked for. Band 1 has them, NaN where they are
/// missing (declared so, transparent, or no height that there is); band 2 is 1 there and 0 elsewhere on the raster.
[[nodiscard]] Dataset heightRaster(Dataset raster, const HeightCode& code, const RasterPlace& place);

} // namespace lumorph::navigation
