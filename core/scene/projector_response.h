#pragma once

#include <glm/vec3.hpp>

#include "core/scene/installation.h"

namespace lumorph {

/// Whether a curve or a black of this projector was measured; else its values are light by sRGB or gamma alone.
[[nodiscard]] bool isResponseMeasured(const InstalledProjector& projector) noexcept;

/// Light of each channel above its black at a value in [0, 1]: 0 at value 0, 1 at value 1. Between the points of a
/// measured curve linearly.
[[nodiscard]] glm::dvec3 lightOfValue(const InstalledProjector& projector, double value);

/// The least value of each channel that makes so much light above its black, both in [0, 1].
[[nodiscard]] glm::dvec3 valueOfLight(const InstalledProjector& projector, const glm::dvec3& light);

/// Light of full white on a white diffuse surface, per channel, at a place (world, metres) with a normal of length 1;
/// 0 where it faces away. Whether the place lies in the picture or in a shadow is not asked.
[[nodiscard]] glm::dvec3 whiteLight(const InstalledProjector& projector, const glm::dvec3& place,
                                    const glm::dvec3& normal);

/// The darkest that all places are made where several projectors overlap, as light on white; 0 where none do, or none
/// has a measured black. A projector cannot send less than its black, and the blacks of two add up: in dark scenes an
/// overlap would stand out as a grey patch with the shape of a picture. As is usual for blended projectors, all else is
/// lifted to the black of the brightest overlap on the table and up to a device's height above it. What is brighter
/// than that stays as it is, and a single projector is never lifted.
[[nodiscard]] glm::vec3 blackFloor(const Installation& installation);

} // namespace lumorph
