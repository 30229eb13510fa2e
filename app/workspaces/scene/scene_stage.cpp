#include "app/workspaces/scene/scene_stage.h"

namespace lumorph::studio {

SceneStage::SceneStage(Studio& /*studio*/, QWidget* parent) : QWidget(parent) { setObjectName("scene.stage"); }

void SceneStage::setActive(bool /*active*/) {}
void SceneStage::setSelected(int /*item*/) {}

} // namespace lumorph::studio
