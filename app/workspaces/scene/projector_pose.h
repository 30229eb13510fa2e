#pragma once

#include <optional>

#include "core/geometry/calibrated_camera.h"

namespace lumorph::studio {

/// Where the middle of a projector's picture falls on the table, x and z; empty where it does not look down.
[[nodiscard]] std::optional<glm::dvec2> lookPoint(const CalibratedCamera& camera);

/// The projector carried to another place; it keeps its direction.
void carryTo(CalibratedCamera& camera, const glm::dvec3& position);

/// The projector turned by as little as it takes for the middle of its picture to fall on a point of the table. Left as
/// it is where it stands in that point.
void lookAt(CalibratedCamera& camera, const glm::dvec2& point);

} // namespace lumorph::studio
