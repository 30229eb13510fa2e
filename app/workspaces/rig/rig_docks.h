#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"
#include "app/workspaces/rig/influence_tools.h"
#include "app/workspaces/rig/rig_selection.h"

namespace lumorph::studio {

/// The actuators of the rig; choosing one shows what it is and, in the view, what it moves.
[[nodiscard]] QWidget* makeRigActuators(Studio& studio, RigSelection& selection);

/// What is wrong with the rig at rest and in motion, as rows that show it in the view, and its shape report. Adds the
/// command "rig.check".
[[nodiscard]] QWidget* makeRigReport(Studio& studio, RigSelection& selection);

/// What the device can be: how well it takes the shapes of the bundled targets, with pictures, and its shape
/// resolution. Follows edits while it is seen. Adds the command "rig.fit.take".
[[nodiscard]] QWidget* makeRigFit(Studio& studio, RigSelection& selection);

/// Which places of the device follow the chosen actuator: tools to edit that in the view. Needs the command "rig.paint".
[[nodiscard]] QWidget* makeRigInfluence(Studio& studio, RigSelection& selection, InfluenceTools& tools);

/// Searches for bend lines of the rig's sheet: few servos, or cheap ones, against the fit over some shapes.
[[nodiscard]] QWidget* makeRigSuggest(Studio& studio);

/// How light reaches the device over all its states, as a map from above and on the device in the view, and where a
/// projector should hang.
[[nodiscard]] QWidget* makeRigLight(Studio& studio, RigSelection& selection);

} // namespace lumorph::studio
