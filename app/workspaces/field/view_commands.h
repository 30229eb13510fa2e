#pragma once

#include <functional>

#include "app/studio/base/commands.h"
#include "app/studio/viewport/viewport_widget.h"

namespace lumorph::studio {

/// Adds the commands view.frameAll, frameSelected, front, right, top, orthographic and gizmo of the workspace "field".
/// `view` gives its viewport, or null. Returns view.gizmo, which is checked while the gizmo is shown.
QAction* addViewCommands(Commands& commands, std::function<ViewportWidget*()> view);

/// The keys of those commands count while the viewport has the keyboard: F, Home and digits belong to lists and numbers
/// elsewhere.
void bindViewShortcuts(Commands& commands, ViewportWidget* view);

} // namespace lumorph::studio
