#pragma once

#include <functional>
#include <utility>
#include <vector>

#include <QMainWindow>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// What only the main window can do.
struct ShellActions {
    std::function<void()> startTour;
    std::function<void()> resetLayout;
    std::function<void()> enterKiosk;
    std::function<void()> changePin;
    std::vector<std::pair<QString, std::function<void()>>> workspaces; ///< title and how to show it, in order
};

/// Adds undo and redo, STOP, the workspaces, and the commands of the menus View and Help.
void addShellCommands(Studio& studio, QMainWindow& window, const ShellActions& does);

} // namespace lumorph::studio
