#pragma once

#include <functional>

#include <QMenu>

#include "app/studio/shell/studio.h"
#include "app/workspaces/scene/scene_selection.h"

namespace lumorph::studio {

/// Adds the commands of the Scene workspace: what can be added, copied, removed; which layer works; techniques.
/// `parent` is asked for the window that dialogs belong to.
void addSceneCommands(Studio& studio, SceneSelection& selection, std::function<QWidget*()> parent);

/// The menu of all that can be added.
void fillAddMenu(Commands& commands, QMenu& menu);

/// An item of a model as it comes into the scene: light alone, riding on the device, its size as the file says.
[[nodiscard]] SceneItem modelItem(const std::filesystem::path& file);

/// Gives the material to what is chosen: an item with a surface, the device or the table. False where it has none.
bool applyMaterial(Studio& studio, const SceneChoice& choice, const Material& material);

} // namespace lumorph::studio
