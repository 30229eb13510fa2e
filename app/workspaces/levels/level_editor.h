#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// Adds "Levels of the labyrinth..." to the File menu: a window in which a level is painted, checked while one paints,
/// played at once and saved as the text that `resources/guide/labyrinth-levels.md` describes. Closing it loses nothing:
/// it is as it was when it is opened again.
void addLevelCommand(Studio& studio);

} // namespace lumorph::studio
