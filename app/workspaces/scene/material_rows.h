#pragma once

#include "app/studio/shell/studio.h"
#include "app/workspaces/scene/scene_form.h"

namespace lumorph::studio {

/// Everything of a material, in sections. `prefix` begins the names of its controls; `metres` says whether its pictures
/// are mapped in metres; the sections are there only while `shown`.
void addMaterialRows(SceneForm& form, Studio& studio, const QString& prefix, const Part<Material>& part,
                     const std::function<bool(const StudioState&)>& metres,
                     const std::function<bool(const StudioState&)>& shown = {});

} // namespace lumorph::studio
