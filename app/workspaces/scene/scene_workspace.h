#pragma once

#include <memory>

#include "app/studio/shell/studio.h"
#include "app/studio/shell/workspace.h"

namespace lumorph::studio {

/// The workspace "Scene": what light shows, as eye, projector and lab see it, in the middle; outliner and library of
/// materials on the left, the inspector on the right.
class SceneWorkspace : public Workspace {
    Q_OBJECT
public:
    explicit SceneWorkspace(Studio& studio);
    ~SceneWorkspace() override;

    [[nodiscard]] QString id() const override;
    [[nodiscard]] QString title() const override;
    [[nodiscard]] QWidget* makeCentralView() override;
    [[nodiscard]] std::vector<WorkspaceDock> makeDocks() override;
    void setSeen(bool seen) override;
    bool setForVisitors(bool on) override;
    bool takeDrop(const std::vector<std::filesystem::path>& files) override;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::studio
