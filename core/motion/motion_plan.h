#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/motion/motion.h"

namespace lumorph {

/// Commands for the frames to come, and the motion that they lead to.
struct MotionPlan {
    std::vector<double> commands;    ///< strokes, one a frame
    std::vector<MotionState> states; ///< at the end of each frame
    double gain = 0.0;               ///< sum over the frames, less what moving costs
};

/// Chooses the commands of one actuator ahead of its motion: those whose motion under the limits (R19) gains most over
/// all frames. Dynamic programming backwards over a grid of positions and velocities whose transitions are those of
/// `advance`, then a pass forwards with the exact motion. Its size, 65 positions x 13 velocities x 33 commands a frame,
/// does not depend on levels. Immutable; safe to share between threads.
class MotionPlanner {
public:
    /// A frame lasts `seconds` > 0. Throws as `advance` does.
    MotionPlanner(const MotionLimits& limits, double seconds);

    /// `gains` has a row a frame, and in each the gain of ending the frame at `count` >= 2 evenly spaced strokes from 0
    /// to 1; between them it is interpolated linearly. Throws InvalidInput when `gains` are no whole rows.
    [[nodiscard]] MotionPlan plan(MotionState start, std::span<const float> gains, std::size_t count) const;
    /// The plan of given commands, one a frame, to compare with.
    [[nodiscard]] MotionPlan follow(MotionState start, std::span<const double> commands, std::span<const float> gains,
                                    std::size_t count) const;

private:
    /// Where a command leads from a node of the grid.
    struct Move {
        std::uint32_t node; ///< below the end in position and velocity
        float upPosition;   ///< share of the way to the next node
        float upVelocity;   ///< likewise
        float cost;         ///< of the way
    };
    void stepBack(std::span<const float> after, std::span<float> before) const;
    [[nodiscard]] float valueAt(std::span<const float> values, const MotionState& state) const;
    [[nodiscard]] Move moveTo(const MotionState& state, double way) const;

    MotionLimits limits_;
    double seconds_;
    std::vector<Move> moves_; ///< [node][command]
};

} // namespace lumorph
