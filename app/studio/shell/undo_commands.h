#pragma once

#include <functional>

#include <QMainWindow>
#include <QUndoGroup>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// Adds undo and redo of the group's active stack. Each says for a moment, over the window's foot, what it took back or
/// did again and in which workspace, and offers to show that one where `present` (titles) is another.
void addUndoCommands(Studio& studio, QMainWindow& window, QUndoGroup& stacks, std::function<QString()> present);

} // namespace lumorph::studio
