#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/registration/fresh_points.h"
#include "calibration/registration/registration_fit.h"
#include "calibration/registration/touch.h"

/// Where the device lies on its tracked body.
namespace lumorph {

/// A point of the device's model, picked beforehand, and the pointer's tip held on it. The touch has a body: the
/// device's. Where the room is known does not matter.
struct TouchedLandmark {
    glm::dvec3 onModel{0.0};           ///< device frame, metres
    std::optional<glm::dvec3> outward; ///< the surface's normal there, by which mirror images show
    Touch touch;
};

struct DevicePlace {
    registration::Figures figures; ///< `bodyFromDevice`, and the tip as it fits best
    double rms = 0.0;              ///< metres
    std::vector<PointError> points;
    double turnSigma = 0.0, shiftSigma = 0.0; ///< radians; metres, in the middle of the points
    double tipSigma = 0.0;                    ///< metres: what of `shiftSigma` the pointer's tip makes
    std::vector<Finding> warnings;
};

/// The rows of touches. Throws CaptureRefused as restOf does, and `tracker_lost` for a touch without the device's body.
struct LandmarkRows {
    std::vector<registration::ModelRow> rows;
    std::vector<std::optional<glm::dvec3>> outward; ///< one a row
    std::vector<std::string> names;
    std::vector<Finding> warnings;
};
[[nodiscard]] LandmarkRows rowsOf(std::span<const TouchedLandmark> touches, const glm::dvec3& tip,
                                  const CaptureFault* undo = nullptr);

/// Rigid fit, then together with the tip. Throws CaptureRefused: `too_few_points`, `points_degenerate`, `mirrored`,
/// `model_does_not_fit`.
[[nodiscard]] DevicePlace placeDevice(const LandmarkRows& touches, const registration::TipRow& tip,
                                      const Progress& progress = {});

/// A marker board glued to the device at a known place, seen by a calibrated camera while the device's body is
/// tracked, both by one clock.
struct BoardOnDevice {
    PoseTrack body;       ///< in the tracker's world
    PoseTrack board;      ///< in the room's
    Pose deviceFromBoard; ///< where it was glued
};
/// The mean of what single moments say; the sigmas are of that mean. Throws CaptureRefused as soundTrack does,
/// `too_few_points` for fewer than 20 shared moments, and `model_does_not_fit` where moments contradict one another.
[[nodiscard]] DevicePlace placeDeviceByBoard(const BoardOnDevice& capture, const Pose& worldFromTracker);

} // namespace lumorph
