#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/units.h"
#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// A perspective camera looking from `eye` at `centre`, +Y up; metres, world frame.
struct Camera {
    glm::vec3 eye{0.0F, 0.0F, 1.0F};
    glm::vec3 centre{0.0F};
    Angle fieldOfView = Angle::degrees(26.0); ///< vertical
    float aspect = 1.0F;                      ///< width over height
    float nearDistance = 0.01F;
    float farDistance = 10.0F;
};

[[nodiscard]] glm::mat4 cameraFromWorld(const Camera& camera);
[[nodiscard]] glm::mat4 clipFromWorld(const Camera& camera);

/// Where a world point falls in a viewport of `size`, pixels from its top left corner. The point must
/// lie in front of the camera.
[[nodiscard]] glm::vec2 pixelOf(const Camera& camera, const glm::vec3& point, glm::vec2 size);

/// The nearest camera that looks along `-direction` (not vertical) and has the whole box within `fill` of its view,
/// centred. Throws InvalidInput for an empty or infinite box.
[[nodiscard]] Camera frameBox(const Box& box, const glm::vec3& direction, float aspect, float fill);

} // namespace lumorph
