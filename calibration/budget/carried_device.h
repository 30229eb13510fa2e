#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "calibration/budget/room_errors.h"

namespace lumorph {

/// A hand that carries the device in circles over the table.
struct CarryingHand {
    double speed = 0.3;           ///< metres a second; 0: the device rests
    double radius = 0.12;         ///< metres
    double samplesASecond = 60.0; ///< of the tracker
};

/// Second moments of what a pose is beside the truth, in the world's axes.
struct PoseMoments {
    Eigen::Matrix3d place = Eigen::Matrix3d::Zero(); ///< metres^2
    Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();  ///< radians^2
};

/// What a PoseStream makes of poses with this noise when it predicts them `ahead` seconds, the delay being exactly
/// that: a carried device is followed for some seconds, and each prediction is compared with where it truly is then.
/// Equal seeds give equal moments. Throws InvalidInput for a hand that is none.
[[nodiscard]] PoseMoments predictionLeaves(const CarryingHand& hand, const PoseError& noise, double ahead,
                                           std::uint32_t seed = 1);

} // namespace lumorph
