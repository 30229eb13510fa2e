#pragma once

#include "app/studio/shell/studio.h"
#include "app/workspaces/field/pose_desk.h"

namespace lumorph::studio {

/// Adds the commands of named poses and their sequence: poses.keep, update, go, remove, addStep, removeStep, play,
/// stop, loop and export. They are enabled while they can do something. Keeping a pose shows the dock of poses.
void addPoseCommands(Studio& studio, PoseDesk& desk);

} // namespace lumorph::studio
