#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"
#include "app/workspaces/common/field_display.h"

namespace lumorph::studio {

/// What of the field the viewport shows: nothing, its voxels or a level surface, of which actuator, between which
/// levels and slices. Writes to `display` and follows it.
[[nodiscard]] QWidget* makeFieldShow(Studio& studio, FieldDisplayModel& display);

/// The ramps of the voxel that was clicked, as a plot.
[[nodiscard]] QWidget* makeVoxelRamps(Studio& studio, FieldDisplayModel& display);

} // namespace lumorph::studio
