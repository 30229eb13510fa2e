#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// The content of the dock "dock.actuators": each actuator's level and value, where it is asked to be and where it is
/// by now; rest, random and dance. Up to 24 actuators have a row each; more are shown as a grid of levels with one row
/// for the chosen one. Uses the commands rig.rest, rig.random, rig.dance, poses.keep and match.live, which must be
/// there.
[[nodiscard]] QWidget* makeActuatorDock(Studio& studio);

} // namespace lumorph::studio
