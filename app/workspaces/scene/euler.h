#pragma once

#include <cmath>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace lumorph::studio {

/// A rotation as a user turns it: heading about +Y, then tilt about its own X, then roll about its own Z; radians. At a
/// tilt of 90 degrees heading and roll are one, and the roll is 0.
[[nodiscard]] inline glm::dvec3 headingTiltRoll(const glm::dquat& rotation) {
    const glm::dmat3 m = glm::mat3_cast(glm::normalize(rotation));
    const double tilt = std::asin(glm::clamp(-m[2][1], -1.0, 1.0));
    if (std::abs(m[2][1]) > 1.0 - 1e-9) return {std::atan2(-m[0][2], m[0][0]), tilt, 0.0};
    return {std::atan2(m[2][0], m[2][2]), tilt, std::atan2(m[0][1], m[1][1])};
}

[[nodiscard]] inline glm::dquat fromHeadingTiltRoll(const glm::dvec3& angles) {
    return glm::angleAxis(angles.x, glm::dvec3(0, 1, 0)) * glm::angleAxis(angles.y, glm::dvec3(1, 0, 0)) *
           glm::angleAxis(angles.z, glm::dvec3(0, 0, 1));
}

} // namespace lumorph::studio
