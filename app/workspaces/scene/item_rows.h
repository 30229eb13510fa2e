#pragma once

#include "app/studio/shell/studio.h"
#include "app/workspaces/scene/scene_form.h"

namespace lumorph::studio {

/// What every item has: visible, opacity, where it rides and stands, what servos and light do with it, its own motion.
void addItemRows(SceneForm& form, Studio& studio, const Part<SceneItem>& item);
/// What only its kind has: model, size, waves, fog, light.
void addKindRows(SceneForm& form, Studio& studio, const Part<SceneItem>& item);
/// Of a light: its direction as a dial and as an hour of the day.
void addLightRows(SceneForm& form, const Part<SceneItem>& item);
/// Of a height field: its size and waves.
void addHeightRows(SceneForm& form, Studio& studio, const Part<SceneItem>& item);

} // namespace lumorph::studio
