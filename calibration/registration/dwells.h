#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace lumorph {

struct TimedPlace {
    double seconds = 0.0;
    glm::dvec3 place{0.0}; ///< metres
};

/// A stretch of time in which something rested at one place.
struct Dwell {
    double from = 0.0, to = 0.0; ///< seconds
    glm::dvec3 place{0.0};       ///< the median of what was there
    std::size_t count = 0;       ///< of samples
    std::size_t first = 0;       ///< of them, among all
};

/// All stretches of at least `shortest` seconds that stay within `radius` metres of their middle, in order. They end
/// where the pointer leaves, so slow drift does not join two places.
[[nodiscard]] std::vector<Dwell> findDwells(std::span<const TimedPlace> places, double shortest = 0.8,
                                            double radius = 0.0015);

} // namespace lumorph
