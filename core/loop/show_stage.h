#pragma once

#include "core/loop/match_frame.h"
#include "core/loop/viewer_stage.h"
#include "core/scene/show_frame.h"

namespace lumorph {

/// From what the loop found to what the passes draw: poses the scene's items. One thread at a time.
class ShowStage {
public:
    /// The frame must have a scene and assets. Where the scene shows the physical layer alone, the device's own surface
    /// is drawn in its material, whole, whatever light makes of it otherwise.
    [[nodiscard]] ShowFrame frame(const MatchFrame& match);
    /// The same with device, viewer and hands as they were looked at anew.
    [[nodiscard]] ShowFrame frame(const MatchFrame& match, NewestView newest);

private:
    [[nodiscard]] std::shared_ptr<const Scene> shown(const std::shared_ptr<const Scene>& scene);

    std::shared_ptr<const Scene> physical_, physicalOf_; ///< what is drawn of the newest one that shows servos alone
    ScenePoser poser_;
};

} // namespace lumorph
