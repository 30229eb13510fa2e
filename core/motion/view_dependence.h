#pragma once

#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "core/base/units.h"
#include "core/rig/rig.h"

namespace lumorph {

/// The bend for a user seen at this elevation above the device's plane: theta - alpha * alpha / theta, alpha held in
/// [0, theta] (paper, "View-dependent shape change"; R20, R21). Overhead nothing bends, at grazing view all. Throws
/// InvalidInput for angles that are not finite, or no `theta` above zero.
[[nodiscard]] Angle viewBend(Angle elevation, Angle theta = Angle::degrees(90.0));

/// Where each actuator acts, as seen from the device's centre: which edges bend up for which user.
class ViewRule {
public:
    /// An actuator's direction is where what it moves lies; one that lifts nothing, or moves no part of the outline,
    /// never bends.
    explicit ViewRule(const Rig& rig);
    /// Strokes of all actuators for an eye in device coordinates: the ones furthest from the user bend, weighted
    /// smoothly by direction, so that no actuator of 90 degrees changes by more than one of 33 levels a degree walked
    /// (R22). An actuator that does not turn (no angle) uses its whole stroke as 90 degrees. A `theta` above 90 degrees
    /// counts as 90. Throws InvalidInput for an eye that is not finite.
    [[nodiscard]] std::vector<double> strokes(const glm::dvec3& eyeInDevice, Angle theta = Angle::degrees(90.0)) const;

private:
    struct Edge {
        glm::dvec2 direction{0.0}; ///< in x and z, length 1
        double share = 0.0;        ///< of the bend that it takes part in; 0: never bends
        double range = 0.0;        ///< radians at full stroke
    };
    glm::dvec3 centre_{0.0}; ///< of the top at rest
    std::vector<Edge> edges_;
};

} // namespace lumorph
