#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "app/applications/navigation/map.h"
#include "app/applications/navigation/view_ground.h"

namespace lumorph::navigation {

/// A flat face of a solid; its corners go round counterclockwise, seen from outside.
struct Face {
    std::vector<glm::vec3> corners; ///< device metres
    Paint paint = Paint::white;
};

/// A building as it stands on the device, `size` times as large as it is. Convex.
[[nodiscard]] std::vector<Face> solidOf(const Building& building, const ViewGround& ground, double size);

/// What of a convex solid stands over the device's sheet: cut clean at its rim, and closed again there. Empty where
/// nothing does.
[[nodiscard]] std::vector<Face> cutAtRim(std::vector<Face> solid);

} // namespace lumorph::navigation
