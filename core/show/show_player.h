#pragma once

#include <memory>

#include "core/base/clock.h"
#include "core/base/progress.h"
#include "core/loop/match_loop.h"
#include "core/loop/show_stage.h"

namespace lumorph {

/// A show without a window: the loop by a clock that the caller owns, and that stands still while a frame is worked
/// out. So refinement always comes to its end, and the same wishes give the same frames whatever this machine's speed.
/// One thread at a time.
class ShowPlayer {
public:
    static constexpr double kStep = 1.0 / 60.0; ///< seconds between frames

    /// The clock outlives the player.
    explicit ShowPlayer(ManualClock& clock, MatchWish wish);

    /// What is asked for from the next frame on.
    [[nodiscard]] const MatchWish& wish() const noexcept { return wish_; }
    void setWish(MatchWish wish) { wish_ = std::move(wish); }

    /// The next frame: the first at once, each other one `seconds` after the one before.
    const std::shared_ptr<const MatchFrame>& step(double seconds = kStep);
    /// Frames of at most one step each until the show is `seconds` old, the first included. Throws Cancelled.
    const std::shared_ptr<const MatchFrame>& playUntil(double seconds, const Progress& progress = {});

    /// The newest frame; empty before the first.
    [[nodiscard]] const std::shared_ptr<const MatchFrame>& frame() const noexcept { return frame_; }
    [[nodiscard]] double seconds() const noexcept { return seconds_; } ///< of the newest frame, since the first
    /// The newest frame as the passes draw it; it needs a scene with its assets.
    [[nodiscard]] ShowFrame shown() { return stage_.frame(*frame_); }

private:
    ManualClock& clock_;
    MatchWish wish_;
    MatchLoop loop_;
    ShowStage stage_;
    std::shared_ptr<const MatchFrame> frame_;
    double seconds_ = 0.0;
};

/// A frame in which the device stands at these strokes, without having moved there, `seconds` after the beginning of
/// scene and target.
[[nodiscard]] std::shared_ptr<const MatchFrame> heldFrame(MatchWish wish, const std::vector<double>& strokes,
                                                          double seconds);

} // namespace lumorph
