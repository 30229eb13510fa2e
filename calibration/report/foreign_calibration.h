#pragma once

#include <string>
#include <string_view>

#include "calibration/report/calibration_record.h"

namespace lumorph {

/// Sizes of the devices where a file does not say them; empty: it must.
struct KnownSizes {
    cv::Size camera, projector;
};

/// A calibration as other programs write it, in YAML, XML or JSON (foreign_text.h): OpenCV's FileStorage under the
/// usual names (K1, M1, cameraMatrix1, cam_K, camera_matrix, cam_int, Kc, ...), at the top or in nodes of their own;
/// ROS's camera_info and echoes of it; Kalibr's camchain, whose second camera is taken as the projector. R may be a
/// rotation vector. What is not said stays empty or 0; what is odd becomes a warning of the result. A projector's file
/// may leave out the size of its camera. Throws DataError with the line; CaptureRefused (lens_model) naming a lens
/// model that is not OpenCV's k1, k2, p1, p2, k3.
[[nodiscard]] CalibrationRecord parseForeignCalibration(std::string_view text, const std::string& name,
                                                        const KnownSizes& sizes = {});

} // namespace lumorph
