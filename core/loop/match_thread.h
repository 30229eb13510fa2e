#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/loop/match_frame.h"
#include "core/loop/match_wish.h"

namespace lumorph {

/// Runs a MatchLoop in a thread of its own at a fixed rate: the newest wish goes in, the newest frame comes out. Idle
/// (nothing moves, no new wish, nobody tracked) it costs next to nothing; a body that is tracked again, or an input to
/// a program, wakes it within a tenth of a second, a wish at once.
class MatchThread {
public:
    /// `onFrame` is called in the loop's thread after each frame; it must return at once.
    explicit MatchThread(std::function<void()> onFrame, double framesPerSecond = 60.0);
    ~MatchThread();
    MatchThread(const MatchThread&) = delete;
    MatchThread& operator=(const MatchThread&) = delete;

    void wish(MatchWish wish);
    void setRate(double framesPerSecond);
    /// While paused, a new wish gets one frame and nothing else does; the pause is no time in which anything moves.
    /// Ending it makes a frame at once.
    void setPaused(bool paused);
    /// The newest frame; empty before the first.
    [[nodiscard]] std::shared_ptr<const MatchFrame> latest() const;
    /// Frames a second over the last second; 0 while idle.
    [[nodiscard]] double rate() const noexcept;
    /// What went wrong in the loop, once; the loop holds still until the next wish.
    [[nodiscard]] std::optional<std::string> takeError();

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph
