#pragma once

#include "core/loop/match_frame.h"
#include "core/loop/match_wish.h"
#include "core/loop/viewer_choice.h"

namespace lumorph {

/// First stage of a frame with a scene: where device and viewer are when its light is seen.
class ViewerStage {
public:
    /// Writes `worldFromDevice`, eye, viewer and hands into a frame that began at its `time`.
    void look(const MatchWish& wish, double sinceLast, MatchFrame& frame);
    /// Whether they will be elsewhere in the next frame with the same wish.
    [[nodiscard]] bool moves() const noexcept { return moves_; }

private:
    ViewerDirector director_;
    bool moves_ = false;
};

/// From a frame to its light, seconds: as the installation has it, or where drawing takes longer (as was measured:
/// `lightDelay`), that. 0 where the installation predicts nothing.
[[nodiscard]] double lightAhead(const Installation& installation, double lightDelay);

/// How far ahead of what trackers say poses are predicted, seconds: by `lightAhead`, and by how much
/// poses are older than they say (`trackerSeconds`). 0 where the installation predicts nothing.
[[nodiscard]] double lookAhead(const Installation& installation, double lightDelay);

/// Whether a tracker has seen one of the board's bodies lately.
[[nodiscard]] bool anyTracked(const PoseBoard& board, Microseconds now);

} // namespace lumorph
