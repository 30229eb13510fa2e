#pragma once

#include <optional>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

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

/// Where device, viewer and hands of a frame will be when its light is seen, by all that trackers have said up to now.
struct NewestView {
    glm::mat4 worldFromDevice{1.0F};
    std::optional<glm::vec3> eye;
    std::vector<Capsule> hands;
    double latency = 0.0; ///< milliseconds from the oldest pose used to the light; 0: nothing is tracked
};

/// A frame waits until it is drawn; trackers go on meanwhile, and what is predicted less far is predicted better. What
/// the frame says stays where nothing newer is known, as of a viewer who is handed over. Source: late latching, as
/// head-mounted displays do it.
[[nodiscard]] NewestView newestView(const MatchFrame& frame);

/// From a frame to its light, seconds: as the installation has it, or where drawing takes longer (as was measured:
/// `lightDelay`), that. 0 where the installation predicts nothing.
[[nodiscard]] double lightAhead(const Installation& installation, double lightDelay);

/// How far ahead of what trackers say poses are predicted, seconds: by `lightAhead`, and by how much
/// poses are older than they say (`trackerSeconds`). 0 where the installation predicts nothing.
[[nodiscard]] double lookAhead(const Installation& installation, double lightDelay);

/// Whether a tracker has seen one of the board's bodies lately.
[[nodiscard]] bool anyTracked(const PoseBoard& board, Microseconds now);

} // namespace lumorph
