#pragma once

#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "core/scene/installation.h"

namespace lumorph::studio {

/// How well a projector's light meets a surface, by area of what faces up (R42).
struct ProjectorReach {
    double missed = 0.0; ///< share that its picture does not cover
    double steep = 0.0;  ///< share of the rest that it meets at more than 70 degrees, or from behind
    double dim = 0.0;    ///< share of what is left then where it cannot show white: too far, slanting or dark
};
inline constexpr double kSteepDegrees = 70.0;

/// Of a surface's triangles with its vertices in its own frame, metres; `albedo` is the share of light that the bare
/// surface gives back, linear.
[[nodiscard]] ProjectorReach reachOf(const InstalledProjector& projector, const glm::vec3& albedo,
                                     const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& triangles,
                                     const glm::mat4& worldFromSurface);

} // namespace lumorph::studio
