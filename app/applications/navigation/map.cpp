#include "app/applications/navigation/map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>

namespace lumorph::navigation {

glm::ivec2 Map::sampleAt(const glm::dvec2& place) const noexcept {
    return glm::clamp(glm::ivec2(glm::round(place / heights.spacing())), glm::ivec2(0), heights.samples() - 1);
}

bool Map::holds(const glm::dvec2& place) const noexcept {
    const glm::dvec2 inside = glm::min(place, heights.size() - place);
    return std::min(inside.x, inside.y) >= 0.0;
}

bool Map::isWater(glm::ivec2 sample) const noexcept {
    if (water.empty()) return false;
    const float level = water[index(sample)];
    return level > heights.at(sample);
}

double Map::waterAt(const glm::dvec2& place) const noexcept {
    if (water.empty() || !holds(place)) return std::numeric_limits<double>::quiet_NaN();
    return static_cast<double>(water[index(sampleAt(place))]);
}

double Map::woodsAt(const glm::dvec2& place) const noexcept {
    return woods.empty() || !holds(place) ? 0.0 : static_cast<double>(woods[index(sampleAt(place))]);
}

} // namespace lumorph::navigation
