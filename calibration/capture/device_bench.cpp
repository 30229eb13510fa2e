#include "calibration/capture/device_bench.h"

#include <cmath>
#include <string>

#include <opencv2/imgproc.hpp>

#include "core/base/error.h"

namespace lumorph {

void fitPicture(cv::Mat& picture, const glm::ivec2& calibrated, const glm::ivec2& wanted) {
    const cv::Size size(wanted.x, wanted.y);
    if (picture.empty() || picture.size() == size) return;
    constexpr double kOblong = 0.01; // of the shape: pixels are whole
    const double own = static_cast<double>(picture.cols) / picture.rows;
    if (std::abs(own * calibrated.y / calibrated.x - 1.0) > kOblong)
        throw InvalidInput("the camera's pictures",
                           "they are " + std::to_string(picture.cols) + " x " + std::to_string(picture.rows) +
                               " pixels, and it was calibrated with " + std::to_string(calibrated.x) + " x " +
                               std::to_string(calibrated.y),
                           "set it to that size, or calibrate it again");
    cv::resize(picture, picture, size, 0.0, 0.0, cv::INTER_AREA);
}

} // namespace lumorph
