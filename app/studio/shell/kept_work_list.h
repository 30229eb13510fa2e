#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// What a piece of kept work is called in a list: the demonstration's title, else the file's name.
[[nodiscard]] QString nameOf(const KeptWork& work, Language language);
/// "14:32"; of another day with its date.
[[nodiscard]] QString timeWords(const QDateTime& time);

/// All kept work: what it is, and buttons that bring it back or throw it away. Opens without blocking (objectName
/// "dialog.keptWork").
void openKeptWork(Studio& studio, QWidget& window);

/// Adds the command "file.bringBack". It says so where kept work needs much space: nothing is removed by itself.
void addKeptWorkCommand(Studio& studio, QWidget& window);

} // namespace lumorph::studio
