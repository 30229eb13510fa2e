#pragma once

#include "core/loop/match_frame.h"
#include "core/scene/show_frame.h"

namespace lumorph {

/// From what the loop found to what the passes draw: poses the scene's items. One thread at a time.
class ShowStage {
public:
    /// The frame must have a scene and assets.
    [[nodiscard]] ShowFrame frame(const MatchFrame& match);

private:
    ScenePoser poser_;
};

} // namespace lumorph
