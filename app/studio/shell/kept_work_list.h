#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// What a piece of kept work is called in a list: the demonstration's title, else the file's name.
[[nodiscard]] QString nameOf(const KeptWork& work, Language language);
/// When something else was opened in its place: the time, of another day with its date.
[[nodiscard]] QString whenOf(const KeptWork& work);

/// All kept work: what it is, and buttons that bring it back or throw it away. Opens without blocking (objectName
/// "dialog.keptWork").
void openKeptWork(Studio& studio, QWidget& window);

/// Adds the command "file.bringBack". It says so where kept work needs much space: nothing is removed by itself.
void addKeptWorkCommand(Studio& studio, QWidget& window);

} // namespace lumorph::studio
