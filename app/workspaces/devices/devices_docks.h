#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"
#include "app/workspaces/devices/servo_selection.h"

namespace lumorph::studio {

/// What was found, an address by hand, and the link to it.
[[nodiscard]] QWidget* makeFoundDock(Studio& studio);
/// Trackers that are open, what they see, and who that is in the show.
[[nodiscard]] QWidget* makeTrackersDock(Studio& studio);
/// Channel, range, direction and limits of the chosen servo, and the profile that they are kept in.
[[nodiscard]] QWidget* makeServoDock(Studio& studio, ServoSelection& selection);
/// What is the same for all servos of a profile: speed, hands, the end, and a Maestro's number.
[[nodiscard]] QWidget* makeSetupDock(Studio& studio);
/// Breaks simulated boards on purpose, and shows what their servos really do.
[[nodiscard]] QWidget* makeSimulatorDock(Studio& studio);
/// What happened, newest first.
[[nodiscard]] QWidget* makeDeviceLog(Studio& studio);

} // namespace lumorph::studio
