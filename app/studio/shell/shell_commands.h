#pragma once

#include <functional>
#include <utility>
#include <vector>

#include <QMainWindow>
#include <QUndoGroup>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// What only the main window can do.
struct ShellActions {
    std::function<void()> startTour;
    std::function<void()> showApplications;
    std::function<void()> resetLayout;
    std::function<QString()> present; ///< title of the workspace that is shown
    QUndoGroup* stacks = nullptr;     ///< of which the shown workspace's is active
    std::function<void()> enterKiosk;
    std::function<void()> changePin;
    std::vector<std::pair<QString, std::function<void()>>> workspaces; ///< title and how to show it, in order
};

/// What STOP and Resume promise, wherever they are offered.
inline constexpr auto kStopPromise =
    "At once: the show holds still, and all servos of a device are let go and go limp (Esc Esc)";
inline constexpr auto kResumePromise =
    "The show goes on. Servos start softly where they are read; else you are asked before they move";

/// Adds undo and redo, STOP, the workspaces, and the commands of the menus View and Help.
void addShellCommands(Studio& studio, QMainWindow& window, const ShellActions& does);

} // namespace lumorph::studio
