#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

#include "calibration/decode/calibration_board.h"
#include "calibration/decode/capture_folder.h"
#include "calibration/decode/pattern_decoder.h"
#include "calibration/patterns/capture_order.h"
#include "calibration/solve/procam_calibration.h"
#include "core/base/progress.h"

namespace lumorph {

/// One pose as it was read.
struct ReadPose {
    ViewObservations observations;
    DecodedView decoded;
    std::vector<Finding> warnings;
};

/// Reads one pose from its images, 8-bit grey, in the order's order; `view` names them and need not be on disk. Throws
/// CaptureRefused at the first fault, InvalidInput where the numbers of images differ.
[[nodiscard]] ReadPose readPose(const CapturedView& view, const std::vector<cv::Mat>& images,
                                const CalibrationBoard& board, const CaptureOrder& order);

/// Adds what is told of a pose; the same board in all poses is named once.
void addWarnings(const std::vector<Finding>& ofPose, std::vector<Finding>& all);

/// What the poses of a capture tell together.
struct ReadCapture {
    std::vector<ViewObservations> views;
    cv::Size camera;
    std::vector<Finding> warnings;
    CaptureOrder order{}; ///< what the images show
};

/// Is told of each pose once it is read, in the threads that read: which one, and what it tells.
using PoseReader = std::function<void(std::size_t index, const ReadPose&)>;

/// How the camera sees the boards.
enum class Sight {
    straight,
    mirrored, ///< in a mirror: each picture is turned left for right first, and pixels are those of what comes out
};

/// Reads poses from disk, side by side. Throws as `calibrateProcamFolder`; InvalidInput where there is none.
[[nodiscard]] ReadCapture readPoses(const std::vector<CapturedView>& poses, const CalibrationBoard& board,
                                    const CaptureOrder& order, const PoseReader& onRead = {},
                                    const Progress& progress = {}, Sight sight = Sight::straight);

/// Solves what was read; the checks that need all poses are made on the way. Throws CaptureRefused, Cancelled.
[[nodiscard]] ProcamCalibration calibrateCapture(const ReadCapture& capture, cv::Size projector,
                                                 const SolveOptions& options = {}, const Progress& progress = {});

/// Calibrates projector and camera from images on disk: `folder` holds one folder a pose, each with the images of the
/// order. Poses are read side by side. Every check of the doctor is made on the way; what only lowers the quality is a
/// warning. Throws CaptureRefused with cause, place and remedy where the capture cannot be trusted; DataError where
/// there is nothing to read; Cancelled.
[[nodiscard]] ProcamCalibration calibrateProcamFolder(const std::filesystem::path& folder,
                                                      const CalibrationBoard& board, const CaptureOrder& order,
                                                      const SolveOptions& options = {}, const Progress& progress = {});

/// Calibrates a camera from pictures of a board, all in one folder. Pictures in which the board is not found are left
/// out with a warning. Throws as above.
[[nodiscard]] ProcamCalibration calibrateIntrinsicsFolder(const std::filesystem::path& folder,
                                                          const CalibrationBoard& board,
                                                          const SolveOptions& options = {},
                                                          const Progress& progress = {});

} // namespace lumorph
