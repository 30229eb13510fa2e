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
    /// smoothly by direction, so that none changes by more than one of its levels a degree walked around the device
    /// (R22): the more levels it has, the sooner it begins. An actuator that does not turn (no angle) uses its whole
    /// stroke as 90 degrees; one that turns both ways rests at 0 degrees, others at stroke 0. A `theta` above 90
    /// degrees counts as 90. Throws InvalidInput for an eye that is not finite.
    [[nodiscard]] std::vector<double> strokes(const glm::dvec3& eyeInDevice, Angle theta = Angle::degrees(90.0)) const;

private:
    struct Edge {
        glm::dvec2 direction{0.0}; ///< in x and z, length 1
        double share = 0.0;        ///< of the bend that it takes part in; 0: never bends
        double flat = 0.0;         ///< the stroke at which it rests
        double range = 0.0;        ///< radians from there to full stroke
        /// It bends wholly while it lies within `full` of straight away from the user, and not at all beyond `none`.
        double full = 0.0, none = 0.0;
    };
    glm::dvec3 centre_{0.0}; ///< of the top at rest
    std::vector<Edge> edges_;
};

} // namespace lumorph
