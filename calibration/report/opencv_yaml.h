#pragma once

#include <string>
#include <string_view>

#include "calibration/report/foreign_calibration.h"

namespace lumorph {

/// OpenCV's YAML, as users of cv::stereoCalibrate write it: cameraMatrix1, distCoeffs1 (camera), cameraMatrix2,
/// distCoeffs2 (projector), R, T, and beside them sizes and RMS.
[[nodiscard]] std::string calibrationYaml(const CalibrationRecord& record);
/// Reads it back, and what other programs write (foreign_calibration.h).
[[nodiscard]] CalibrationRecord parseCalibrationYaml(std::string_view text, const std::string& name,
                                                     const KnownSizes& sizes = {});

} // namespace lumorph
