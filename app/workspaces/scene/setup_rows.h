#pragma once

#include "app/studio/shell/studio.h"
#include "app/workspaces/scene/scene_form.h"

namespace lumorph::studio {

// What is always there: the rows of the inspector for each.

void addDeviceRows(SceneForm& form, Studio& studio);
void addTableRows(SceneForm& form, Studio& studio);
void addProjectorRows(SceneForm& form, Studio& studio, const Part<InstalledProjector>& projector);
void addViewerRows(SceneForm& form, Studio& studio);
void addRoomRows(SceneForm& form);

} // namespace lumorph::studio
