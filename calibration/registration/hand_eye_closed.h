#pragma once

#include "calibration/registration/hand_eye_fit.h"

/// The closed form of hand_eye.h, which needs no guess: private to it.
namespace lumorph::hand_eye {

inline constexpr const char* kBodies = "recordings of two bodies"; ///< what a refusal is about

/// What the caller calls A and B.
struct Names {
    const char* a = "first";
    const char* b = "second";
};

/// Poses of both at the same moments.
struct Both {
    Pose a, b;
};
[[nodiscard]] std::vector<Both> together(const PoseTrack& a, const PoseTrack& b, const ClockOffset& clocks);

struct ClosedForm {
    Pose bFromA, worldBFromWorldA;
    /// It turned about its own origin: whether both are in one unit, and both worlds right-handed, is not known then.
    bool aInPlace = false, bInPlace = false;
};

/// Rotation and place from relative motions (Park and Martin 1994). Throws CaptureRefused: `motion_degenerate` with the
/// motion that is missing; `mirrored`, and `wrong_units` near the ratio of two units, where that explains the places;
/// `model_does_not_fit` where they do not turn alike, or are of two sizes at another ratio.
[[nodiscard]] ClosedForm closedForm(std::span<const Both> both, const Names& names);

} // namespace lumorph::hand_eye
