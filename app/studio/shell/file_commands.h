#pragma once

#include <filesystem>
#include <vector>

#include <QWidget>

#include "app/studio/shell/studio.h"

class QMenu;

namespace lumorph::studio {

/// Adds new, open, save, save as and quit; their dialogs open over `window`.
void addFileCommands(Studio& studio, QWidget& window);
/// Fills a menu with the recent files each time it is shown.
void fillRecentMenu(Studio& studio, QMenu& menu);

/// Opens files that were dropped together: at most one that says what the device is (a project, a field, a folder of
/// states), first, and one target after it. Whatever is left over is named in a notice.
void openDropped(Studio& studio, const std::vector<std::filesystem::path>& files);

} // namespace lumorph::studio
