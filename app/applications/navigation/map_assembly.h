#pragma once

#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "app/applications/navigation/building_tags.h"
#include "app/applications/navigation/map.h"
#include "app/applications/navigation/map_import.h"

namespace lumorph::navigation {

/// What files told, in metres of one projection (easting, northing), before it is a map.
struct MapSources {
    /// Heights from west to east, the rows from north to south; NaN: missing. Empty: none.
    std::vector<float> heights;
    glm::ivec2 samples{0};
    double spacing = 0.0;   ///< metres
    glm::dvec2 origin{0.0}; ///< of the north-western sample

    struct Outline {
        std::vector<glm::dvec2> ring;               ///< without its first corner again at the end
        std::vector<std::vector<glm::dvec2>> holes; ///< courtyards, the same way
        BuildingShape shape;
        Words name;
    };
    struct Line {
        std::vector<glm::dvec2> points;
        double width = 4.0; ///< metres
    };
    struct Name {
        Words text;
        glm::dvec2 at{0.0};
        double width = 1000.0;
        int rank = 2;
    };
    std::vector<Outline> outlines;
    std::vector<Line> lines;
    std::vector<Name> names;
};

/// Makes a map of it: level ground where there are no heights, holes in the heights filled from around them, colours by
/// height and slope. Adds to the report what does not fit. Throws InvalidInput where there is nothing to show.
[[nodiscard]] Map assembled(MapSources sources, MapReport& report);

} // namespace lumorph::navigation
