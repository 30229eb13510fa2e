#pragma once

#include <optional>
#include <vector>

#include <glm/mat4x4.hpp>

#include "core/geometry/capsule.h"
#include "core/geometry/triangle_mesh.h"
#include "core/loop/pose_stream.h"
#include "core/scene/installation.h"

namespace lumorph {

/// Metres from the nearest tracked hand (a body in the role `pointer`) to the device's box; 0 inside it. Empty where
/// `now` no hand is seen: then nothing senses hands, and none may be said to be far. `box` is in the device's frame,
/// in metres; `worldFromDevice` is rigid, as in MatchFrame; the installation says where its trackers are and where the
/// tip of a hand is. Of tip and body the nearer counts. A tracker tells no more of a hand: where the tip was not
/// measured, fingers reach up to 0.2 m beyond it.
[[nodiscard]] std::optional<double> handDistance(const PoseBoard& board, const Box& box,
                                                 const glm::mat4& worldFromDevice, Microseconds now,
                                                 const Installation& installation = {});

/// The room that a hand around a place takes, with the forearm behind it, world metres. It is the hand of a visitor who
/// stands where this eye is: fingers point away from him, and the arm comes from him. Without an eye a ball that a hand
/// hardly leaves: nothing tells where the arm is.
[[nodiscard]] std::vector<Capsule> handAt(const glm::vec3& place, const std::optional<glm::vec3>& eye);

/// The same from what a tracker says of its body. Where the tip was measured that tells the direction instead: a finger
/// (or stick) from the tip to the body, and behind the body hand and forearm.
[[nodiscard]] std::vector<Capsule> handShape(const Installation& installation, const Pose& tracked,
                                             const std::optional<glm::vec3>& eye);

} // namespace lumorph
