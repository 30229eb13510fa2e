#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/rig/rig.h"
#include "core/scene/installation.h"

/// What a visitor is asked to touch. Each list begins with places far apart, so that its first ones serve the fit and
/// its last ones, which lie between them, are fresh points.
namespace lumorph {

/// A dot for a projector to show on the table.
struct PlannedDot {
    glm::dvec2 pixel{0.0};
    glm::dvec3 place{0.0}; ///< where it should fall, room, metres
};
/// Dots on the lit part of the table, beside the device where it is believed to lie. Fewer than `count` where there is
/// no room for more. Throws InvalidInput for a projector that is not there.
[[nodiscard]] std::vector<PlannedDot> planDots(const Installation& room, std::size_t projector, const Rig& rig,
                                               std::size_t count);

/// A point of the device that a pointer reaches: a corner of the mesh on its upper side that no actuator moves, as far
/// as there are such.
struct PlannedLandmark {
    glm::dvec3 onModel{0.0}; ///< device frame, metres
    glm::dvec3 outward{0.0, 1.0, 0.0};
    bool operator==(const PlannedLandmark&) const = default;
};
[[nodiscard]] std::vector<PlannedLandmark> planLandmarks(const Rig& rig, std::size_t count);

} // namespace lumorph
