#pragma once

#include <cstdint>

#include "core/scene/installation.h"

namespace lumorph {

/// A hand that carries the device to and fro over the table, and the tracker that watches it.
struct CarriedDevice {
    double speed = 0.3;          ///< metres a second, at its fastest
    double seconds = 15.0;       ///< of motion
    double noiseMetres = 0.0003; ///< standard deviation of the tracker's places, along each axis
    double noiseRadians = 0.001; ///< likewise of its turns
    double rate = 60.0;          ///< poses and pictures a second
    std::uint32_t seed = 1;
};

/// How far light lies beside the place on the device that it is meant for, root mean square, metres.
struct LightSlip {
    double always = 0.0;  ///< over the whole motion, turning points and all
    double atSpeed = 0.0; ///< while the hand moves nearly at its fastest
};

/// What it is worth to look ahead.
struct PredictionGain {
    LightSlip with, without;
};

/// Carries the device of the virtual lab by the loop's own stages: poses go through a PoseStream and ViewerStage as
/// `believed` says, and their light appears as late as in `truth`. Of both only the delays count, so that the slip is
/// that of delays alone. Takes some milliseconds; the same for the same seed. Throws InvalidInput for a speed, a time
/// or a rate that is not positive.
[[nodiscard]] PredictionGain predictionGain(const Installation& believed, const Installation& truth,
                                            const CarriedDevice& carried = {});

} // namespace lumorph
