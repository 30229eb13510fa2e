#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
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

/// What came of reading or solving: a refusal is a result too.
template <class Result> using OrFinding = std::variant<Result, Finding>;

/// Gets each pose as it is read, also one that is refused.
using PoseTaker = std::function<void(CalibrationPose)>;

/// The poses in the folder of a setup, all but those `without`. Throws DataError where there is none; Cancelled.
[[nodiscard]] OrFinding<ReadCapture> readFolder(const CalibrationSetup& setup, const std::vector<std::string>& without,
                                                const PoseTaker& take, const Progress& progress);

/// What is solved, and for which room.
struct SolveTask {
    ReadCapture capture;
    cv::Size projector; ///< pixels
    CalibrationSetup setup;
    std::optional<BoardPoints> flat; ///< of the pose that lay on the table
    std::shared_ptr<const Installation> room;
    RoomPlacement placement;
    bool knowsSize = false; ///< the projector's; else a doubt about it is told
};
/// Throws what the solver throws where it is no refusal; Cancelled.
[[nodiscard]] OrFinding<std::shared_ptr<const CalibrationResult>> solveCapture(const SolveTask& task,
                                                                               const Progress& progress);

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
