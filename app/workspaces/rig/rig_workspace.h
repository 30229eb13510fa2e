#pragma once

#include <memory>

#include "app/studio/shell/studio.h"
#include "app/studio/shell/workspace.h"

namespace lumorph::studio {

/// The workspace "Rig": the device as it stands, its actuators on the left, its checks and shape report on the right.
class RigWorkspace : public Workspace {
    Q_OBJECT
public:
    explicit RigWorkspace(Studio& studio);
    ~RigWorkspace() override;

    [[nodiscard]] QString id() const override;
    [[nodiscard]] QString title() const override;
    [[nodiscard]] QWidget* makeCentralView() override;
    [[nodiscard]] std::vector<WorkspaceDock> makeDocks() override;
    void setSeen(bool seen) override;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::studio
