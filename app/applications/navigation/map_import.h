#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "app/applications/navigation/map.h"
#include "core/base/progress.h"

namespace lumorph::navigation {

/// What was read of map files, and what could not be taken as it is.
struct MapReport {
    std::vector<Words> notes; ///< plain sentences: what was left out, mended or guessed, and why
    std::size_t buildings = 0, roads = 0, places = 0;
    std::size_t heightMissing = 0;       ///< buildings whose height the file does not tell; they got one
    std::size_t mended = 0;              ///< outlines that crossed themselves
    std::size_t closed = 0;              ///< rings that were not closed
    std::size_t leftOut = 0;             ///< things that no outline could be made of, or beyond the ground
    double filled = 0.0;                 ///< share of the heights that were missing and were taken from around, 0 to 1
    std::vector<std::string> passedOver; ///< names of files of which nothing is shown; `notes` say why
};

struct ImportedMap {
    Map map;
    MapReport report;
    std::string projection; ///< of the metres of the map, such as "EPSG:32632"; empty: none is known
    glm::dvec2 origin{0.0}; ///< easting and northing of its north-western sample there, metres
};

/// Reads a file, or all files of a folder: heights (GeoTIFF, 16-bit PNG or Terrarium colours, SRTM .hgt, .asc and the
/// like; several make one ground) and outlines with heights, lines and names (GeoJSON, CityJSON, shapefile, GeoPackage,
/// OSM as .osm or .pbf). All of it is brought into metres (UTM of its middle). However large the file, the ground gets
/// at most `kMostSamples` samples a side, and no more than some strips of the file are in memory at a time. Without
/// heights the ground is level. What is no map, or has no heights, is passed over and named. Throws DataError where
/// nothing can be shown at all, naming the file, why and what to do; Cancelled.
[[nodiscard]] ImportedMap importMap(const std::filesystem::path& fileOrFolder, const Progress& progress = {});

/// What was read, as a JSON object for programs: `lowest` and `highest` of the ground in metres, how many `buildings`,
/// metres of the `tallest`, and the files `passedOver`.
[[nodiscard]] std::string figuresOf(const ImportedMap& imported);

inline constexpr int kMostSamples = 2049;
inline constexpr std::size_t kMostBuildings = 2500; ///< the largest are kept

} // namespace lumorph::navigation
