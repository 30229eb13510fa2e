#pragma once

#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "app/applications/navigation/map.h"
#include "app/applications/navigation/view_ground.h"

namespace lumorph::navigation {

inline constexpr int kStoreys = 4, kBays = 8; ///< that the picture of a wall has, the topmost storey without windows

/// A flat face of a solid; its corners go round counterclockwise, seen from outside.
struct Face {
    std::vector<glm::vec3> corners; ///< device metres
    Paint paint = Paint::white;
    int shade = 0;
    /// Of a wall with windows: its foot at one end, and what there is of bays along and of storeys up in a metre.
    struct Windows {
        glm::vec3 foot{0.0F}, bays{0.0F}, storeys{0.0F};
    };
    std::optional<Windows> windows;
};

/// A building as it stands on the device, `size` times as large as it is. Convex.
[[nodiscard]] std::vector<Face> solidOf(const Building& building, const ViewGround& ground, double size);

/// What of a convex solid stands over the device's sheet: cut clean at its rim, and closed again there. Empty where
/// nothing does.
[[nodiscard]] std::vector<Face> cutAtRim(std::vector<Face> solid);

} // namespace lumorph::navigation
