#pragma once

#include <glm/vec3.hpp>

namespace lumorph::studio {

/// The sun's hour in [6, 18] from the direction towards it: it rises at 6 in +X, stands highest at 12, sets at 18 in
/// -X.
[[nodiscard]] double hourOf(const glm::vec3& direction);

/// Towards the sun at an hour, on the arc that leads through `now`: an arc leans to the front or the back. One that
/// stands on the horizon goes on an arc that leans to the back. Length 1.
[[nodiscard]] glm::vec3 sunAt(double hour, const glm::vec3& now);

} // namespace lumorph::studio
