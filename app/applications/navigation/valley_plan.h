#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

namespace lumorph::navigation {

/// Where the waters of the valley run and its town stands, before there are any mountains.
struct ValleyPlan {
    static constexpr double kSide = 8192.0;     ///< metres
    static constexpr double kLakeLevel = 420.0; ///< metres over the sea
    static constexpr double kRiverHalf = 14.0;  ///< half its width, metres

    std::vector<glm::dvec2> river, outflow; ///< downstream
    double mouth = 1.0;                     ///< share of the river at which it meets the lake
    glm::dvec2 lake{0.0};
    std::vector<double> shore; ///< radius of the lake from its middle, evenly around, first to the east
    glm::dvec2 town{0.0};      ///< its square
    glm::dvec2 inland{0.0};    ///< from the lake to the town, length 1

    /// Radius of the lake in a direction, metres.
    [[nodiscard]] double shoreAt(double angle) const noexcept;
    [[nodiscard]] glm::dvec2 shorePoint(double angle) const noexcept;
    /// How far a place lies from the shore, metres; negative in the lake. Near the shore, about.
    [[nodiscard]] double fromLake(const glm::dvec2& place) const noexcept;

    /// The nearest water.
    struct Water {
        double distance = 0.0; ///< metres from its edge; negative in it
        double level = 0.0;    ///< of its surface, metres over the sea
        double depth = 0.0;    ///< at the place, metres
    };
    [[nodiscard]] Water waterNear(const glm::dvec2& place) const noexcept;
};

[[nodiscard]] ValleyPlan planValley(std::uint64_t seed);

} // namespace lumorph::navigation
