#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"
#include "app/workspaces/devices/device_words.h"
#include "app/workspaces/devices/servo_selection.h"

namespace lumorph::studio {

/// The view in the middle: the card with the next step, the servos live, and what is known of board and link. Needs the
/// commands of the workspace.
[[nodiscard]] QWidget* makeServoBoard(Studio& studio, ServoSelection& selection);

/// All that the card's words are about, as it is now.
[[nodiscard]] DeviceView deviceViewOf(Studio& studio);
[[nodiscard]] QStringList servoNamesOf(Studio& studio);

} // namespace lumorph::studio
