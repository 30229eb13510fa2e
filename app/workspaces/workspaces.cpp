#include "app/workspaces/workspaces.h"

#include "app/workspaces/calibrate/calibrate_workspace.h"
#include "app/workspaces/devices/devices_workspace.h"
#include "app/workspaces/field/field_workspace.h"
#include "app/workspaces/levels/level_editor.h"
#include "app/workspaces/rig/rig_workspace.h"
#include "app/workspaces/scene/scene_workspace.h"

namespace lumorph::studio {

std::vector<std::unique_ptr<Workspace>> makeWorkspaces(Studio& studio) {
    std::vector<std::unique_ptr<Workspace>> workspaces;
    workspaces.push_back(std::make_unique<RigWorkspace>(studio));
    workspaces.push_back(std::make_unique<FieldWorkspace>(studio));
    workspaces.push_back(std::make_unique<SceneWorkspace>(studio));
    workspaces.push_back(std::make_unique<CalibrateWorkspace>(studio));
    workspaces.push_back(std::make_unique<DevicesWorkspace>(studio));
    addLevelCommand(studio);
    return workspaces;
}

} // namespace lumorph::studio
