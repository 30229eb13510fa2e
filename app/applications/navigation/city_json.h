#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

namespace lumorph::navigation {

/// A building of a CityJSON file (cityjson.org, version 1.0 to 2.0).
struct CityBuilding {
    std::string name;
    std::vector<glm::dvec3> footprint; ///< in the file's reference system
    double height = 0.0;               ///< from its lowest to its highest corner, metres
};

struct CityModel {
    int epsg = 0; ///< of its coordinates; 0: not told
    std::vector<CityBuilding> buildings;
    std::size_t withoutShape = 0; ///< objects of which no footprint could be found
};

/// Whether a file is one, by its beginning.
[[nodiscard]] bool isCityJson(const std::filesystem::path& file);

/// Throws DataError for a file that is no CityJSON, is damaged, or points beyond its vertices.
[[nodiscard]] CityModel readCityJson(const std::filesystem::path& file);

} // namespace lumorph::navigation
