#pragma once

#include <memory>

#include <opencv2/core.hpp>

#include "core/base/progress.h"

namespace lumorph {

class BoardLab;

/// Where pictures of a calibration become light. One thread at a time.
class PatternDisplay {
public:
    virtual ~PatternDisplay() = default;

    /// Pixels of the projector.
    [[nodiscard]] virtual cv::Size size() const = 0;
    /// Shows 8-bit grey or BGR of that size, and returns once it is on the screen. How much later it is light, the
    /// capture measures (pose_capture.h). Throws InvalidInput for another size, DeviceError where it cannot be shown,
    /// Cancelled.
    virtual void show(const cv::Mat& picture, const Progress& progress) = 0;
    /// Gives the screen back to what was shown before.
    virtual void clear() = 0;
};

/// The virtual lab's projector; the lab outlives it.
[[nodiscard]] std::unique_ptr<PatternDisplay> openLabDisplay(BoardLab& lab);

/// Throws InvalidInput unless it is 8-bit grey or BGR of this size.
void checkPicture(const cv::Mat& picture, cv::Size size);

} // namespace lumorph
