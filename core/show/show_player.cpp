#include "core/show/show_player.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lumorph {

ShowPlayer::ShowPlayer(ManualClock& clock, MatchWish wish) : clock_(clock), wish_(std::move(wish)), loop_(clock) {}

const std::shared_ptr<const MatchFrame>& ShowPlayer::step(double seconds) {
    if (!frame_) seconds = 0.0;
    seconds_ += seconds;
    clock_.advance(Microseconds(std::llround(1e6 * seconds)));
    frame_ = loop_.step(wish_, seconds);
    return frame_;
}

const std::shared_ptr<const MatchFrame>& ShowPlayer::playUntil(double seconds, const Progress& progress) {
    if (!frame_) step();
    const double from = seconds_;
    const double left = std::max(0.0, seconds - from);
    const auto steps = static_cast<int>(std::ceil(left / kStep - 1e-9));
    for (int i = 0; i < steps; ++i) {
        progress.throwIfCancelled();
        step(left / steps);
        progress.report(static_cast<double>(i + 1) / steps, "following the show");
    }
    return frame_;
}

std::shared_ptr<const MatchFrame> heldFrame(MatchWish wish, const std::vector<double>& strokes, double seconds) {
    wish.driver = Driver::hand;
    wish.strokes = strokes;
    wish.sceneSeek = seconds;
    wish.seek = seconds;
    const ManualClock clock;
    auto frame = std::make_shared<MatchFrame>(*MatchLoop(clock).step(wish, 0.0));
    // The loop starts its actuators at rest, and moves them under their limits.
    frame->estimatedStrokes = strokes;
    frame->devicePositions = std::make_shared<std::vector<glm::vec3>>(deformed(*wish.rig, strokes).positions);
    return frame;
}

} // namespace lumorph
