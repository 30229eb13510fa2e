#pragma once

#include <optional>
#include <string>
#include <vector>

#include <QPointF>

#include "app/studio/calibration/calibration_state.h"
#include "calibration/doctor/capture_calibration.h"

namespace lumorph::studio {

// What the jobs of a calibration work out, beside the window.

/// A pose that was read, with its pictures. `projector`: its size in pixels.
[[nodiscard]] CalibrationPose poseOf(const std::string& name, const ReadPose& read, cv::Size projector);

/// A pose that was refused, with the picture (8-bit; may be empty) in which one sees why.
[[nodiscard]] CalibrationPose poseRefusedBy(const Finding& finding, const cv::Mat& picture);

/// Of the images of a pose the one that shows most.
[[nodiscard]] cv::Mat brightestOf(const std::vector<cv::Mat>& images);

/// The image that a refusal is about, or one of its pose; empty where it cannot be read.
[[nodiscard]] cv::Mat pictureOfFinding(const std::vector<CapturedView>& views, const Finding& finding);

/// Nothing where it is not known in which pose the board lay on the table, or that cannot be.
[[nodiscard]] std::optional<ErrorPlan> planOf(const ProcamCalibration& solved, const std::optional<BoardPoints>& flat,
                                              const CalibrationBoard& board, const Installation& room,
                                              const RoomPlacement& placement, const Progress& progress);

/// How far each point lies beside the solution, a pose each.
[[nodiscard]] std::vector<PoseResiduals> residualsOf(const std::vector<ViewObservations>& views,
                                                     const ProcamCalibration& solved);

/// The points of the board in a live picture, in its pixels; empty where it is not found. Found in a small picture, so
/// that the live one stays live.
[[nodiscard]] std::vector<QPointF> liveCorners(const cv::Mat& picture, const CalibrationBoard& board);

} // namespace lumorph::studio
