#pragma once

#include <opencv2/core.hpp>

#include "calibration/lab/lab.h"

/// What the lab's photographers of device and table share.
namespace lumorph {

/// 8-bit grey as a picture for a projector.
[[nodiscard]] Image pictureOf(const cv::Mat& grey);

/// Radiance of a sight under the pictures that are shown, the mean of its channels.
[[nodiscard]] cv::Mat1f lightIn(const Lab& lab, const LabSight& sight);

/// Grey levels of radiance 1, so that what is seen under full white of all projectors comes to `white`; but for the
/// brightest hundredth, which may be overexposed. Leaves the projectors white. Throws InvalidInput where the camera
/// sees nothing that they light; `what` is the capture, for the message.
[[nodiscard]] double exposureOf(Lab& lab, const LabSight& sight, double white, const char* what);

} // namespace lumorph
