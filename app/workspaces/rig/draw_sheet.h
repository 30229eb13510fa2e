#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"
#include "core/rig/templates/sheet_device.h"

namespace lumorph::studio {

/// The window in which a sheet device is drawn: the page, what comes of it beside, and undo of its own. What is
/// accepted becomes the document's rig by one step of undo. Closing it loses nothing: it is kept as it was, and what is
/// opened later comes as one more step of its undo.
void openDrawSheet(Studio& studio, QWidget* parent, SheetDevice drawing);

/// The same with the drawing of the document's rig (`RigParts::drawing`); names, servos and limits that the rig's
/// actuators were given since are kept when it is made again. A drawing that cannot be read is told as a notice.
void openDrawingOfRig(Studio& studio, QWidget* parent);

/// `made` with what was set by hand on the actuators of the same name in `before`: suggested levels, damping, drive,
/// and the velocity limit where the range is still the same.
[[nodiscard]] RigParts carriedOver(RigParts made, const RigParts& before);

} // namespace lumorph::studio
