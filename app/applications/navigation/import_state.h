#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "app/applications/navigation/import_gdal.h"
#include "app/applications/navigation/map_assembly.h"
#include "app/applications/navigation/map_import.h"
#include "core/base/words.h"

namespace lumorph::navigation {

/// What an import has read so far. Its readers add to it, heights first.
struct ImportState {
    MapSources sources;
    MapReport report;
    std::string projection;           ///< of the map; empty until it is known
    bool metresOnly = false;          ///< the map lies nowhere on Earth: plain metres
    std::vector<std::string> systems; ///< of the rasters, as well-known text, each once
    bool any = false;                 ///< something was read
    Words problem;                    ///< why the first of the files that are passed over is

    /// Says something of a file.
    void note(const std::filesystem::path& file, const Words& text);
    /// Says why nothing of a file is shown.
    void passOver(const std::filesystem::path& file, const Words& why);
    /// The map gets the UTM zone of a place on Earth, unless it has a projection.
    void chooseSystem(const glm::dvec2& lonLat);
};

/// From the coordinates of a file to metres of the map.
struct WayToMap {
    OGRSpatialReference from = OGRSpatialReference();
    Transformation transformation = nullptr; ///< null: they are those of the map
};

/// What coordinates are that could be degrees, in a file that names no system.
enum class Unsaid { degrees, metres };

/// Finds the way for a file of outlines by what it says of its system (`said`; null: nothing) and by some of its
/// points. Coordinates that cannot be degrees though the file says so, or says nothing, are metres: those of the
/// heights beside it where they lie on them, plain ones where there are none; that is said. Where nothing fits, the
/// file is passed over, and there is no way.
[[nodiscard]] std::optional<WayToMap> wayToMap(ImportState& state, const std::filesystem::path& file,
                                               const OGRSpatialReference* said, const std::vector<glm::dvec2>& points,
                                               Unsaid unsaid = Unsaid::degrees);

/// Reads rasters: all that have heights become one ground in metres.
void readGround(const std::vector<std::filesystem::path>& files, ImportState& state, const Progress& progress);
/// Reads outlines, lines and names.
void readOutlines(const std::filesystem::path& file, ImportState& state, const Progress& progress);
/// Reads the buildings of a CityJSON file.
void readCity(const std::filesystem::path& file, ImportState& state);

} // namespace lumorph::navigation
