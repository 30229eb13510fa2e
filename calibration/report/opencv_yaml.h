#pragma once

#include <string>
#include <string_view>

#include "calibration/report/calibration_record.h"

namespace lumorph {

/// Sizes of the devices where a file does not say them; empty: it must.
struct KnownSizes {
    cv::Size camera, projector;
};

/// OpenCV's YAML, as users of cv::stereoCalibrate write it: cameraMatrix1, distCoeffs1 (camera), cameraMatrix2,
/// distCoeffs2 (projector), R, T, and beside them sizes and RMS.
[[nodiscard]] std::string calibrationYaml(const CalibrationRecord& record);
/// Reads the usual spellings: K1, M1, cameraMatrix1, cam_K, camera_matrix, and so on; R may be a rotation vector. A
/// strict reader of our own: OpenCV's ends the program on some texts. Throws DataError with the line.
[[nodiscard]] CalibrationRecord parseCalibrationYaml(std::string_view text, const std::string& name,
                                                     const KnownSizes& sizes = {});

} // namespace lumorph
