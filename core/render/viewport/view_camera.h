#pragma once

#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/units.h"
#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// A half line in world metres; `direction` has length 1.
struct Ray {
    glm::vec3 origin{0.0F};
    glm::vec3 direction{0.0F, 0.0F, -1.0F};
};

/// The camera of a viewport: it circles a pivot, +Y stays up. Plain data; the functions below move it.
struct ViewCamera {
    glm::vec3 pivot{0.0F}; ///< world metres
    Angle yaw;             ///< 0 looks along -Z (from the front), 90 degrees along -X (from the right)
    Angle pitch;           ///< 0 is level, 90 degrees looks straight down
    double distance = 0.6; ///< from pivot to eye, metres
    bool orthographic = false;
    Angle fieldOfView = Angle::degrees(28.0); ///< vertical; at the pivot both projections show the same extent
    bool operator==(const ViewCamera&) const = default;
};

[[nodiscard]] glm::vec3 eyeOf(const ViewCamera& camera);
[[nodiscard]] glm::mat4 viewFromWorld(const ViewCamera& camera);
/// Near and far planes hold `scene` as tightly as precision needs.
[[nodiscard]] glm::mat4 clipFromWorld(const ViewCamera& camera, float aspect, const Box& scene);

/// The ray through a pixel (from the top left corner) of a viewport of `size` pixels.
[[nodiscard]] Ray rayThrough(const ViewCamera& camera, glm::vec2 pixel, glm::vec2 size);
/// Where a world point falls, pixels from the top left corner; empty behind the eye.
[[nodiscard]] std::optional<glm::vec2> pixelOf(const ViewCamera& camera, const glm::vec3& point, glm::vec2 size);
/// Metres that one pixel spans at a world point.
[[nodiscard]] float metresPerPixel(const ViewCamera& camera, const glm::vec3& point, glm::vec2 size);

/// Turned by a drag of `pixels`; a drag over the viewport's height is half a turn. Pitch stays in [-90, 90] degrees.
[[nodiscard]] ViewCamera orbited(ViewCamera camera, glm::vec2 pixels, glm::vec2 size);
/// Moved so that what is at the pivot's depth follows the cursor.
[[nodiscard]] ViewCamera panned(ViewCamera camera, glm::vec2 pixels, glm::vec2 size);
/// Nearer by `factor` > 1, farther below 1, the point under `pixel` at the pivot's depth staying there; distance stays
/// in [1 mm, 100 m].
[[nodiscard]] ViewCamera zoomed(ViewCamera camera, double factor, glm::vec2 pixel, glm::vec2 size);
/// The same direction, with the box centred in `fill` of the view. An empty box changes nothing.
[[nodiscard]] ViewCamera framed(ViewCamera camera, const Box& box, float aspect, float fill = 0.8F);
/// Looking from `side` (for example +Y: from above) at the same pivot and distance; any direction but zero.
[[nodiscard]] ViewCamera lookingFrom(ViewCamera camera, const glm::vec3& side);
/// Between two cameras, for a short glide; `t` in [0, 1], turning the shorter way.
[[nodiscard]] ViewCamera between(const ViewCamera& from, const ViewCamera& to, double t);

} // namespace lumorph
