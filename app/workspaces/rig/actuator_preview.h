#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "app/studio/document/rig_edit.h"

namespace lumorph::studio {

/// Edits of one actuator while something is dragged, each of them of the actuator as it was when the drag began.
class ActuatorPreview {
public:
    using Edit = std::function<void(Actuator&)>;
    explicit ActuatorPreview(StudioDocument& document) : document_(document) {}

    void show(std::size_t actuator, const Edit& edit) {
        if (!document_.previewing()) base_ = document_.state().rig.parts;
        previewRig(document_, [&](RigParts& parts) {
            if (actuator >= parts.actuators.size() || !base_ || actuator >= base_->actuators.size()) return;
            Actuator edited = base_->actuators[actuator];
            edit(edited);
            parts.actuators[actuator] = std::move(edited);
        });
    }

private:
    StudioDocument& document_;
    std::shared_ptr<const RigParts> base_; ///< the parts when the drag began
};

} // namespace lumorph::studio
