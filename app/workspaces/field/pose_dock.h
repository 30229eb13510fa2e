#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"
#include "app/workspaces/field/pose_desk.h"

namespace lumorph::studio {

/// Named poses as a list, with their strokes as small bars, and the sequence of them as a timeline with what plays it.
/// Uses the commands of `addPoseCommands`, which must be there.
[[nodiscard]] QWidget* makePoseDock(Studio& studio, PoseDesk& desk);

} // namespace lumorph::studio
