#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/motion/pose_sequence.h"
#include "devices/controllers/device_profile.h"

namespace lumorph {

/// Poses that a board is to show without a computer.
struct BoardSequence {
    PoseSequence sequence; ///< a stroke for each servo of the profile
    /// Pin of a button to ground that starts it, and stops it; none: it begins by itself at power on and never ends.
    std::optional<int> button;
};

/// What of it the board plays.
struct BoardPlan {
    PoseSequence sequence;          ///< within the profile's limits, in whole frames of 20 ms
    std::vector<double> from;       ///< where servos begin whose place the board does not know: the exit strokes
    std::size_t bytes = 0;          ///< of flash
    std::vector<std::string> notes; ///< what is other than it was asked for, in plain sentences
};

/// Flash of the longest sequence there may be, for twelve servos; a Pro Mini has 30,720 beside its bootloader, and room
/// for it beside the sketch.
inline constexpr std::size_t kMostSequenceBytes = 2 * 12 * (kMaxPoses + 2) + 10 * kMaxPoseSteps;
/// Pins that a button may have: all but the serial line, the battery's, the lamp's and those of servos.
[[nodiscard]] std::vector<int> buttonPins(const DeviceProfile& profile);

/// Each way is made as long as velocity and acceleration of the profile need, the first one from wherever the button
/// may have stopped the sequence. A linear way, whose speed begins at once, becomes a smooth one.
/// Throws InvalidInput: no sequence for these servos or too long a one, a pin that no button can have.
[[nodiscard]] BoardPlan planForBoard(const DeviceProfile& profile, const BoardSequence& sequence);

/// The file poses.h of the sketch in devices/firmware/tablet. Throws as planForBoard.
[[nodiscard]] std::string posesHeader(const DeviceProfile& profile, const BoardSequence& sequence);

} // namespace lumorph
