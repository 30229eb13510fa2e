#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/clock.h"
#include "core/base/progress.h"
#include "core/geometry/model.h"
#include "core/mdf/coverage.h"
#include "core/mdf/placement.h"
#include "core/mdf/voting.h"

namespace lumorph {

/// More frames are refused: an hour at 30 a second has as many as can be matched overnight.
inline constexpr int kMaxClipFrames = 120'000;

/// Seconds.
inline constexpr double kMostLookAhead = 10.0;

struct ClipOptions {
    double framesPerSecond = 30.0;
    bool refined = true;         ///< false: by voting alone
    Microseconds budget{10'000}; ///< for refinement, each frame
    /// How much of what follows each command is chosen for at least, seconds, 0 to kMostLookAhead; 0: frame by frame.
    double lookAhead = 1.0;
    std::optional<Placement>
        placement; ///< where the target stands; as large as fits over the whole animation when empty
};

/// One frame of a matched animation.
struct ClipFrame {
    double seconds = 0.0;
    State wanted;                 ///< what matching this frame alone asks for
    std::vector<double> commands; ///< strokes that the actuators move to between the frame before and this one
    std::vector<double> strokes;  ///< where the actuators are under their velocity limits
    double iouWanted = 0.0;       ///< of V(wanted) with the frame's target
    double iouReached = 0.0;      ///< of the volume really covered with the frame's target
};

/// Matches an animation frame by frame and moves the actuators under their limits (R19), starting at rest: after each
/// frame's state, or looking ahead by commands that make up for the limits and for the softness of the motion
/// (ClipPlanner). The target is placed once.
/// Throws InvalidInput for a frame rate outside 1..240, a look-ahead outside its range, an animation without duration
/// or of more than kMaxClipFrames frames, Cancelled.
[[nodiscard]] std::vector<ClipFrame> matchClip(const Field& field, const Coverage& coverage, const Voting& voting,
                                               const Model& model, const Model::Animation& animation,
                                               const ClipOptions& options = {}, const Progress& progress = {});

/// One line a frame: time, IoU wanted and reached, then level and stroke of each actuator by name.
[[nodiscard]] std::string clipCsv(const Field& field, const std::vector<ClipFrame>& frames);

} // namespace lumorph
