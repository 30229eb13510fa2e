#pragma once

#include "core/loop/pose_stream.h"
#include "core/scene/installation.h"

namespace lumorph {

/// What a tracked body stands for, in the room: the world of its tracker lies in the room's (`worldFromTracker`), the
/// device lies on its body (`bodyFromDevice`), a pointer or hand is its tip (`pointerTip`), and a head stays its body,
/// whose eye is `eyeFromHead` away. Figures that say nothing (identity, zero) leave the pose bit for bit.
[[nodiscard]] Pose inRoom(const Installation& installation, PoseRole role, const Pose& tracked);

/// What a tracker says of a body that stands for this there in the room: of a device, of a pointer's tip, or of the eye
/// of a head, whose body is `eyeFromHead` away. `inRoom` leads back, for a head to its body. Figures that say nothing
/// leave the pose bit for bit.
[[nodiscard]] Pose trackedOf(const Installation& installation, PoseRole role, const Pose& stands);

/// The body itself in the room, whatever it stands for.
[[nodiscard]] Pose bodyInRoom(const Installation& installation, const Pose& tracked);

} // namespace lumorph
