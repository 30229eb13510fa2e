#pragma once

#include <glm/vec2.hpp>

#include "core/geometry/calibrated_camera.h"
#include "core/render/viewport/view_camera.h"
#include "core/scene/show_frame.h"

namespace lumorph::studio {

/// The ray through a point of a camera's picture; (0, 0) is the corner of the picture, not the centre of its first
/// pixel.
[[nodiscard]] Ray rayThrough(const CalibratedCamera& camera, glm::vec2 at);

/// The item whose surface a ray meets first; 0 when it meets the device itself first, or nothing.
[[nodiscard]] int pickItem(const ShowFrame& frame, const Ray& ray);

/// Around the surfaces of an item, world metres; empty when it has none.
[[nodiscard]] Box boxOf(const ShowFrame& frame, int item);

} // namespace lumorph::studio
