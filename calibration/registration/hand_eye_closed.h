#pragma once

#include "calibration/registration/hand_eye_fit.h"

/// The closed form of hand_eye.h, which needs no guess: private to it.
namespace lumorph::hand_eye {

inline constexpr const char* kBodies = "recordings of two bodies"; ///< what a refusal is about

/// Rotation and place from relative motions (Park and Martin 1994), the clocks being known. Throws CaptureRefused as
/// solveHandEye does: too few moments, `motion_degenerate` with the motion that is missing, `mirrored`, `wrong_units`,
/// `model_does_not_fit` where they do not turn alike.
[[nodiscard]] Unknowns closedForm(const PoseTrack& a, const PoseTrack& b, const ClockOffset& clocks);

} // namespace lumorph::hand_eye
