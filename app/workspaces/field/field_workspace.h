#pragma once

#include <memory>

#include "app/studio/shell/studio.h"
#include "app/studio/shell/workspace.h"
#include "app/studio/viewport/viewport_widget.h"

namespace lumorph::studio {

/// The workspace "Field": the device and its target in the middle, live; actuators and field on the left, target and
/// match on the right.
class FieldWorkspace : public Workspace {
    Q_OBJECT
public:
    explicit FieldWorkspace(Studio& studio);
    ~FieldWorkspace() override;

    [[nodiscard]] QString id() const override;
    [[nodiscard]] QString title() const override;
    [[nodiscard]] QWidget* makeCentralView() override;
    [[nodiscard]] std::vector<WorkspaceDock> makeDocks() override;
    void setSeen(bool seen) override;
    bool setForVisitors(bool on) override;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::studio
