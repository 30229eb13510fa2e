#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// Dialogs of the shell. Each opens without blocking, so that STOP stays in reach, and deletes itself; one that is open
/// already is raised.
void openSettings(Studio& studio, QWidget& window);  ///< objectName "dialog.settings"
void openShortcuts(Studio& studio, QWidget& window); ///< "dialog.shortcuts": every command that has keys
void openAbout(QWidget& window);                     ///< "dialog.about"

} // namespace lumorph::studio
