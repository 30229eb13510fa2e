#pragma once

#include "app/studio/shell/studio.h"
#include "app/workspaces/scene/scene_form.h"

namespace lumorph::studio {

/// Rows that say how well servos take the shape of the chosen item, while it is for them: the fit as of a target, what
/// no servo can show, or who moves the servos instead, with a button that lets the item. Names begin with "item.fit".
void addItemFitRows(SceneForm& form, Studio& studio, const Part<SceneItem>& item);

} // namespace lumorph::studio
