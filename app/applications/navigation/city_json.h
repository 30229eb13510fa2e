#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

namespace lumorph::navigation {

/// A face of a building, in its file's reference system.
struct CityFace {
    enum class Means { unsaid, ground, roof, other };
    std::vector<glm::dvec3> ring;
    std::vector<std::vector<glm::dvec3>> holes;
    Means means = Means::unsaid;
};

/// A building, or a part of one, of a CityJSON file (cityjson.org, version 1.0 to 2.0), in its highest level of detail.
struct CityBuilding {
    std::string id, name;
    std::vector<CityFace> faces;           ///< empty: it has no shape of its own
    double detail = -1.0;                  ///< its level of detail
    std::optional<double> height;          ///< by its attributes, metres
    std::optional<std::size_t> wholeIndex; ///< of the building that it is a part of
};

struct CityModel {
    std::string system; ///< of its coordinates, as the file says it; empty: it does not
    std::vector<CityBuilding> buildings;
    /// Objects that are broken, each with its id and why.
    std::vector<std::pair<std::string, std::string>> broken;
};

/// Whether a file is one, by the type of its root, wherever that stands.
[[nodiscard]] bool isCityJson(const std::filesystem::path& file);

/// Throws DataError for a file that is no CityJSON, or damaged as a whole.
[[nodiscard]] CityModel readCityJson(const std::filesystem::path& file);

} // namespace lumorph::navigation
