#pragma once

#include <optional>

#include <glm/mat4x4.hpp>

#include "core/geometry/triangle_mesh.h"
#include "core/loop/pose_stream.h"

namespace lumorph {

/// Metres from the nearest tracked hand (a body in the role `pointer`) to the device's box; 0 inside it. Empty where
/// `now` no hand is seen: then nothing senses hands, and none may be said to be far. `box` is in the device's frame,
/// in metres; `worldFromDevice` is rigid, as in MatchFrame. A tracker tells one point of a hand: fingers reach up to
/// 0.2 m beyond it.
[[nodiscard]] std::optional<double> handDistance(const PoseBoard& board, const Box& box,
                                                 const glm::mat4& worldFromDevice, Microseconds now);

} // namespace lumorph
