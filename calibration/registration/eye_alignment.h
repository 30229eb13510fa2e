#pragma once

#include <span>
#include <string>
#include <vector>

#include "calibration/registration/fresh_points.h"
#include "calibration/registration/registration_fit.h"
#include "calibration/registration/touch.h"

/// The eye in the frame of a tracked head, by what it sees covered.
namespace lumorph {

/// A visitor holds the pointer so that its tip covers a mark on the table for the one eye that counts. The touch's body
/// is the head.
struct Alignment {
    glm::dvec3 mark{0.0}; ///< in the room, metres
    Touch touch;
};

struct EyePlace {
    glm::dvec3 eyeFromHead{0.0}; ///< metres
    glm::dvec3 sigma{0.0};       ///< metres, with what is open of tip and tracker
    double tipSigma = 0.0;       ///< metres, over all axes: what of it the pointer's tip makes
    double rms = 0.0;            ///< metres between the eye and the lines on which it should lie
    std::vector<PointError> points;
    std::vector<Finding> warnings;
};

/// The rows of alignments. Throws CaptureRefused as restOf does, and `tracker_lost` for one without a head.
using SightRows = registration::NamedRows<registration::SightRow>;
[[nodiscard]] SightRows rowsOf(std::span<const Alignment> alignments, const glm::dvec3& tip,
                               const CaptureFault* undo = nullptr);

/// How well that is known by which lines of sight are made.
struct SightBase {
    registration::TipRow tip;
    /// Metres and radians of the tracker's world in the room's along each axis, about the room's origin, besides
    /// `tipShare`.
    double trackerShift = 0.0, trackerTurn = 0.0;
    /// What an error of the tip shifts the tracker's world by, as a share of it, against the tip: where the same tip
    /// was used for both.
    double tipShare = 0.0;
};

/// The point nearest to all lines from marks through tips, then by the angles that it sees. Tip and tracker stay as
/// they are; their errors are carried to the eye. Throws CaptureRefused:
/// `too_few_points` for fewer than 8, `points_degenerate` where the tip was too near to its mark, `motion_degenerate`
/// where the head saw all marks in one direction, so that how far away the eye is stays open, `model_does_not_fit`.
[[nodiscard]] EyePlace placeEye(const SightRows& alignments, const Pose& worldFromTracker, const SightBase& base,
                                const Progress& progress = {});

} // namespace lumorph
