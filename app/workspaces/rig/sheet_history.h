#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <QString>

#include "core/rig/templates/sheet_device.h"

namespace lumorph::studio {

/// The steps of a drawing, each with the whole of it.
class SheetHistory {
public:
    [[nodiscard]] const SheetDevice& now() const noexcept { return steps_[at_].device; }
    [[nodiscard]] bool canUndo() const noexcept { return at_ > 0; }
    [[nodiscard]] bool canRedo() const noexcept { return at_ + 1 < steps_.size(); }
    [[nodiscard]] const QString& undoText() const noexcept { return steps_[at_].name; }
    [[nodiscard]] const QString& redoText() const noexcept { return steps_[at_ + 1].name; }

    /// A further step; those that were undone are gone.
    void push(SheetDevice device, QString name) {
        steps_.resize(at_ + 1);
        steps_.push_back({std::move(device), std::move(name)});
        ++at_;
    }
    void undo() noexcept { at_ -= canUndo() ? 1 : 0; }
    void redo() noexcept { at_ += canRedo() ? 1 : 0; }

private:
    struct Step {
        SheetDevice device;
        QString name;
    };
    std::vector<Step> steps_{1};
    std::size_t at_ = 0;
};

} // namespace lumorph::studio
