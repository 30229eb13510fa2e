#pragma once

#include <optional>
#include <span>

#include "calibration/registration/pose_track.h"

namespace lumorph {

/// The tip of a pointer that was turned a little while it rested here and there, without knowing where: the point of
/// its frame that stands still in most of the stretches in which it turned. Nothing where it never turned at rest.
[[nodiscard]] std::optional<glm::dvec3> steadyTip(std::span<const TimedPose> poses);

} // namespace lumorph
