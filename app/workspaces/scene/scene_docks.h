#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"
#include "app/workspaces/scene/scene_selection.h"

namespace lumorph::studio {

/// Below this a dock of the Scene workspace cannot be read, points.
inline constexpr int kLeastDockWidth = 220;

/// What light shows, as a tree, with the switch of which layer works.
[[nodiscard]] QWidget* makeOutlinerDock(Studio& studio, SceneSelection& selection);
/// Ready materials to give to what is chosen.
[[nodiscard]] QWidget* makeLibraryDock(Studio& studio, SceneSelection& selection);
/// Every property of what is chosen.
[[nodiscard]] QWidget* makeInspectorDock(Studio& studio, SceneSelection& selection);

} // namespace lumorph::studio
