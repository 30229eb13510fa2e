#pragma once

#include "core/loop/pose_stream.h"
#include "core/scene/installation.h"

namespace lumorph {

/// What a tracked body stands for, in the room: the world of its tracker lies in the room's (`worldFromTracker`), the
/// device lies on its body (`bodyFromDevice`), a pointer or hand is its tip (`pointerTip`), and a head stays its body,
/// whose eye is `eyeFromHead` away. Figures that say nothing (identity, zero) leave the pose bit for bit.
[[nodiscard]] Pose inRoom(const Installation& installation, PoseRole role, const Pose& tracked);

/// The body itself in the room, whatever it stands for.
[[nodiscard]] Pose bodyInRoom(const Installation& installation, const Pose& tracked);

} // namespace lumorph
