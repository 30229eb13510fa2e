#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <opencv2/core.hpp>

#include "calibration/patterns/capture_order.h"
#include "core/base/progress.h"

namespace lumorph {

/// A device whose actuators stand where they are told, before projectors and a camera: the lab's, or one on the table.
class DeviceBench {
public:
    virtual ~DeviceBench() = default;
    /// Brings the actuators there slowly, each from where it stands, one commanded stroke an actuator from 0 to 1;
    /// returns once nothing moves any more. Throws DeviceError with what to do, Cancelled.
    virtual void stand(std::span<const double> commanded, const Progress& progress) = 0;
    /// The pictures of an order on one projector, the others dark: 8-bit grey, in the order's order. Fewer, or empty
    /// ones, where the camera failed. Throws CaptureRefused for a series that cannot be trusted, DeviceError,
    /// Cancelled.
    [[nodiscard]] virtual std::vector<cv::Mat> photograph(std::size_t projector, const CaptureOrder& order,
                                                          const Progress& progress) = 0;
};

/// Makes a camera's picture as large as it is `wanted`. Throws InvalidInput for one of another shape than that of the
/// pictures with which it was `calibrated`: which part of its view that is nobody knows.
void fitPicture(cv::Mat& picture, const glm::ivec2& calibrated, const glm::ivec2& wanted);

} // namespace lumorph
