#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/delays/flash_delay.h"
#include "calibration/delays/mark_delay.h"
#include "calibration/delays/step_lag.h"
#include "calibration/delays/tracker_delay.h"
#include "calibration/lab/true_room.h"
#include "core/loop/prediction_gain.h"

/// All delays measured in the virtual lab from beginning to end: what hardware would be asked to do is done in the true
/// room, with the noise of its tracker and camera, and solved as that of hardware is.
namespace lumorph {

/// What can be wrong while delays are measured.
enum class DelayFault {
    none,
    framesLost,      ///< the camera loses every sixth picture
    cameraUnplugged, ///< from a third of each recording on there are no pictures
    cameraSlow,      ///< eight pictures a second
    lightCovered,    ///< something lies over the camera where the flashes are
    trackerDropsOut, ///< the tracker sees nothing for half a second
    nothingMoves,    ///< nobody moves the board
    servoDead,       ///< the second servo stays at rest
    servoJammed      ///< the second servo meets a stop at 0.55
};
/// "frames", "camera", "slow", "covered", "tracker", "still", "dead", "jammed". Throws InvalidInput.
[[nodiscard]] DelayFault parseDelayFault(std::string_view text);

struct DelaysLabOptions {
    LabErrors errors;
    DelayFault fault = DelayFault::none;
    int flashes = 36;
    double markSeconds = 15.0, boardSeconds = 30.0;
    int stepRounds = 3;
    double cameraRate = 29.8;      ///< pictures a second; no camera keeps step with a projector
    double exposure = 0.01;        ///< seconds
    double readout = 0.018;        ///< seconds from the first row's exposure to the last's
    double brightnessNoise = 0.01; ///< of the flash's own
    double pixelNoise = 0.3;       ///< of a mark in a camera's picture, pixels
    double pacingSeconds = 0.0007; ///< by which single frames' light comes early or late
};

/// What the flashes looked like, and what is to be known of the lab's camera, for tests of the estimators.
[[nodiscard]] FlashRecording recordFlashesInLab(const Installation& truth, std::uint32_t seed,
                                                const DelaysLabOptions& options = {});
[[nodiscard]] MarkRecording recordMarkInLab(const Installation& truth, std::uint32_t seed,
                                            const DelaysLabOptions& options = {});
/// One servo after the other. Those whose part the camera does not see are left out. Throws InvalidInput for more than
/// 64 actuators.
[[nodiscard]] std::vector<StepRecording> recordStepsInLab(const Rig& rig, const Installation& believed,
                                                          const Installation& truth, std::uint32_t seed,
                                                          const Progress& progress = {},
                                                          const DelaysLabOptions& options = {});

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
    PredictionGain gain;  ///< slip on a device that a hand carries through the true room, with and without prediction
    [[nodiscard]] bool good() const { return !refusal; }
};

/// Throws Cancelled, which leaves nothing behind; InvalidInput without a projector.
[[nodiscard]] MeasuredDelays measureDelaysInLab(const Rig& rig, const Installation& believed, const Installation& truth,
                                                std::uint32_t seed, const Progress& progress = {},
                                                const DelaysLabOptions& options = {});

/// The room with delays and lags of another, and nothing else of it.
void takeDelays(const Installation& measured, Installation& room);

/// How far light lies beside on a device that a hand carries at 0.3 m/s at most through `truth`, with the delays that
/// are believed and without prediction. All else is taken to be right, since this is what delays are worth.
[[nodiscard]] PredictionGain slipInLab(const Installation& believed, const Installation& truth, std::uint32_t seed,
                                       const LabErrors& errors = {});

} // namespace lumorph
