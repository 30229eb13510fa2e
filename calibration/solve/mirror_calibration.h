#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/solve/procam_calibration.h"

namespace lumorph {

/// One pose of the board before a projector whose light the camera sees only by way of a plane mirror.
struct MirrorView {
    std::string name;
    /// The board in the mirror: camera pixels as they are in the picture, while the board's points are named as they
    /// are on the board. A board is found so in the picture turned left for right (`cv::flip`), whose column x is
    /// column width - 1 - x of the picture.
    BoardPoints mirrored;
    std::vector<ProjectorPoint> light; ///< on the board in the mirror, picture pixels likewise
    BoardPoints direct; ///< the same pose of the board seen past the mirror, no light needed; empty where it is not
};

/// A plane mirror in the camera's frame: the points X with normal . X = distance.
struct MirrorPlane {
    cv::Vec3d normal; ///< of length 1, away from the camera
    double distance = 0.0;
    double normalSigma = 0.0;   ///< radians
    double distanceSigma = 0.0; ///< the board's unit, as the distance
};

/// What views in a mirror tell.
struct MirrorCalibration {
    /// As from a capture without a mirror. `projectorFromCamera` and the boards' poses are of the true camera where the
    /// mirror is known; else of the camera's mirror image turned left for right, and no more than the lenses counts.
    ProcamCalibration procam;
    std::optional<MirrorPlane> mirror; ///< nothing where no pose was also seen directly
};

/// Solves for camera, projector, boards and mirror together, without a guess. Throws CaptureRefused as calibrateProcam
/// does, and where what is seen directly contradicts what is seen in the mirror; Cancelled.
[[nodiscard]] MirrorCalibration calibrateMirrored(const std::vector<MirrorView>& views, cv::Size camera,
                                                  cv::Size projector, const Progress& progress = {});

} // namespace lumorph
