#pragma once

#include "app/studio/shell/studio.h"
#include "app/studio/shell/workspace.h"
#include "app/workspaces/devices/servo_selection.h"

namespace lumorph::studio {

/// The workspace "Devices": what drives the servos, how the rig hangs on it, and boards to break.
class DevicesWorkspace : public Workspace {
    Q_OBJECT
public:
    explicit DevicesWorkspace(Studio& studio);

    [[nodiscard]] QString id() const override;
    [[nodiscard]] QString title() const override;
    [[nodiscard]] QWidget* makeCentralView() override;
    [[nodiscard]] std::vector<WorkspaceDock> makeDocks() override;
    void setActive(bool active) override;
    void setSeen(bool seen) override;
    [[nodiscard]] QUndoStack* undoStack() override;

private:
    Studio& studio_;
    ServoSelection selection_;
    bool active_ = false;
};

} // namespace lumorph::studio
