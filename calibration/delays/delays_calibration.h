#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/delays/flash_delay.h"
#include "calibration/delays/mark_delay.h"
#include "calibration/delays/step_lag.h"
#include "calibration/delays/tracker_delay.h"
#include "core/loop/prediction_gain.h"
#include "core/rig/rig.h"
#include "core/scene/installation.h"

/// All delays of a room from what was recorded, in the lab or of hardware.
namespace lumorph {

/// Servos whose steps are recorded, at most: a device with more keeps the lags that it has.
inline constexpr std::size_t kMostSteppedServos = 64;

/// What is recorded of delays, all by the clock of the loop. Flashes alone, without mark, poses and steps, tell of the
/// light alone.
struct DelaysCapture {
    FlashRecording flashes;
    MarkRecording mark;
    PoseTrack tracked, seen;          ///< a board that is turned, by the tracker and by the camera
    std::vector<StepRecording> steps; ///< one a servo whose part the camera sees
    double seconds = 0.0;             ///< that it took
};

/// Delays as they were measured.
struct MeasuredDelays {
    /// As it was believed to be, with delays and lags replaced and their origin said; unchanged where it was refused.
    /// A servo whose curve was not measured gets a lag alone, and goes on doing what it is told.
    Installation installation;
    std::optional<Finding> refusal;
    std::vector<Finding> warnings;
    MeasuredDelay light;   ///< from a frame to its light, by flashes
    MeasuredDelay tracker; ///< by which poses are older than they say
    MeasuredDelay mark; ///< from a motion to its light, by a mark that follows: what both come to, never fitted to them
    struct Servo {
        std::string name;
        StepLag step;
    };
    std::vector<Servo> servos;
    std::string summary;  ///< one sentence
    double seconds = 0.0; ///< that it takes
    /// Slip on a device that a hand carries through the true room, with and without prediction; empty where nobody
    /// knows that room.
    std::optional<PredictionGain> gain;
    [[nodiscard]] bool good() const { return !refusal; }
    /// Only light was timed: all else stays as it was believed.
    [[nodiscard]] bool isOfLightAlone() const { return mark.events == 0 && tracker.events == 0; }
};

/// A capture that cannot be trusted becomes a `refusal`. Throws Cancelled.
[[nodiscard]] MeasuredDelays solveDelays(const Rig& rig, const Installation& believed, const DelaysCapture& capture,
                                         const Progress& progress = {});

/// The room with delays and lags of another, and nothing else of it.
void takeDelays(const Installation& measured, Installation& room);

} // namespace lumorph
