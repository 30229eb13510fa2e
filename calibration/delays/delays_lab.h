#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "calibration/delays/delays_calibration.h"
#include "calibration/lab/true_room.h"

/// What delays are measured by, recorded in the virtual lab: what hardware would be asked to do is done in the true
/// room, with the noise of its tracker and camera.
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
/// All that is recorded of them. Throws Cancelled; InvalidInput without a projector.
[[nodiscard]] DelaysCapture captureDelaysInLab(const Rig& rig, const Installation& believed, const Installation& truth,
                                               std::uint32_t seed, const Progress& progress = {},
                                               const DelaysLabOptions& options = {});

/// How far light lies beside on a device that a hand carries at 0.3 m/s at most through `truth`, with the delays that
/// are believed and without prediction. All else is taken to be right, since this is what delays are worth.
[[nodiscard]] PredictionGain slipInLab(const Installation& believed, const Installation& truth, std::uint32_t seed);

} // namespace lumorph
