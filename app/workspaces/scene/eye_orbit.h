#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/units.h"

namespace lumorph::studio {

/// How far a simulated viewer may go around the device: degrees above its horizon and metres away.
inline constexpr double kLowestElevation = 5.0, kHighestElevation = 88.0;
inline constexpr double kNearestEye = 0.3, kFarthestEye = 2.0;

/// Where an eye stands around a centre.
struct EyePlace {
    Angle azimuth; ///< 0 in front (+Z), 90 degrees on the right (+X)
    Angle elevation;
    double distance = 0.7; ///< metres
};
[[nodiscard]] EyePlace placeOf(const glm::vec3& eye, const glm::vec3& centre);
/// The eye at a place, held within the bounds above.
[[nodiscard]] glm::vec3 eyeAt(const EyePlace& place, const glm::vec3& centre);

/// The eye after a drag of `pixels` in a view of `size` pixels: what is seen turns with the hand; a drag over the
/// view's height is half a turn.
[[nodiscard]] glm::vec3 orbitedEye(const glm::vec3& eye, const glm::vec3& centre, glm::vec2 pixels, glm::vec2 size);
/// Nearer by so many notches of the wheel, farther for negative ones.
[[nodiscard]] glm::vec3 nearerEye(const glm::vec3& eye, const glm::vec3& centre, double notches);

} // namespace lumorph::studio
