#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"
#include "app/workspaces/common/field_display.h"

namespace lumorph::studio {

/// The content of the dock "dock.field": what the mechanical distance field is and how good, what of it is shown, the
/// ramps of the voxel that was clicked, and building a finer one. Reads the field from the document and writes what is
/// shown to `display`, which must outlive it. Adds the command `field.build`, which opens the build dialog.
[[nodiscard]] QWidget* makeFieldDock(Studio& studio, FieldDisplayModel& display);

} // namespace lumorph::studio
