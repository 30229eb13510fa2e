#pragma once

#include <memory>

#include "core/base/clock.h"
#include "core/loop/match_frame.h"
#include "core/loop/match_wish.h"

namespace lumorph {

/// One frame after another: show program -> tracked poses -> viewer -> scene time -> pose of the target -> voxels ->
/// levels, or heights
/// -> strokes -> view dependence -> motion limits -> estimated state -> deformed device. Keeps what one frame hands to
/// the next: last levels, motion, dance, buffers. One thread at a time.
class MatchLoop {
public:
    explicit MatchLoop(const Clock& clock);
    ~MatchLoop();
    MatchLoop(MatchLoop&&) noexcept;
    MatchLoop& operator=(MatchLoop&&) noexcept;

    /// `sinceLast` seconds have passed since the frame before. An actuator goes on where it is when the rig has the
    /// same actuators or is an edit of the one before, else it starts at rest. Throws InvalidInput when the wish
    /// contradicts itself.
    [[nodiscard]] std::shared_ptr<const MatchFrame> step(const MatchWish& wish, double sinceLast);

    /// No frame was made for `seconds`, and the next step does not count them: nothing moves meanwhile but the
    /// servos, which come to rest at their last commands.
    void rest(double seconds);

    /// Whether another step with the last wish would change nothing: nothing plays, turns or dances, no program moves,
    /// nobody is tracked,
    /// the actuators have arrived (within 1e-5 strokes; or are stopped) and refinement has nothing left to try.
    [[nodiscard]] bool settled() const noexcept;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph
