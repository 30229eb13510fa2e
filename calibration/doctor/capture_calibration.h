#pragma once

#include <filesystem>

#include "calibration/decode/calibration_board.h"
#include "calibration/patterns/capture_order.h"
#include "calibration/solve/procam_calibration.h"
#include "core/base/progress.h"

namespace lumorph {

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
