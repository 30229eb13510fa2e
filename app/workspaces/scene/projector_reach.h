#pragma once

#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "core/geometry/calibrated_camera.h"

namespace lumorph::studio {

/// How well a projector's light meets a surface, by area of what faces up (R42).
struct ProjectorReach {
    double missed = 0.0; ///< share that its picture does not cover
    double steep = 0.0;  ///< share of the rest that it meets at more than 70 degrees, or from behind
};
inline constexpr double kSteepDegrees = 70.0;

/// Of a surface's triangles with its vertices in its own frame, metres.
[[nodiscard]] ProjectorReach reachOf(const CalibratedCamera& projector, const std::vector<glm::vec3>& positions,
                                     const std::vector<glm::uvec3>& triangles, const glm::mat4& worldFromSurface);

} // namespace lumorph::studio
