#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/loop/pose_stream.h"

namespace lumorph {

/// How far predicted places lie from where the body was then, metres.
struct PlaceError {
    double rms = 0.0;
    double p95 = 0.0; ///< 95 % are nearer
};

struct PredictionReplay {
    PlaceError predicted;
    /// Of the newest sample and a velocity that is the difference of the newest sample and one `velocitySeconds`
    /// earlier. That time is the one of 20 to 250 ms that serves best on this very recording, which is not known while
    /// a body moves: constant velocity at its best.
    PlaceError constantVelocity;
    double velocitySeconds = 0.0;
    /// Of the straight line of least squares through the samples of the last `lineSeconds`, chosen likewise.
    PlaceError line;
    double lineSeconds = 0.0;
    double turnRms = 0.0, constantTurnRms = 0.0; ///< radians: predicted, and by the difference of two samples likewise
    std::size_t count = 0;                       ///< poses that were compared
};

/// Plays a recording into a PoseStream sample by sample, with noise of `noiseMetres` (standard deviation per axis, and
/// 4 mrad of turns for each millimetre, as of a body of a quarter of a metre), and compares what is predicted `ahead`
/// seconds after each with the recording itself, between its poses straight and without noise. The first second, and
/// what falls into gaps, does not count. The same for the same seed. Times must rise. Throws InvalidInput for what is
/// negative or no number, and for a recording that ends before anything can be compared.
[[nodiscard]] PredictionReplay replayPrediction(std::span<const PoseSample> recording, double ahead, double noiseMetres,
                                                std::uint32_t seed = 1);

} // namespace lumorph
