#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// Asks how the board is to start the poses, then for a folder, and writes the whole sketch there as a job.
void openPoseExport(Studio& studio, QWidget* parent);

} // namespace lumorph::studio
