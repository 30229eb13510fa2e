#include "calibration/patterns/phase_shift.h"

#include <cmath>
#include <numbers>

#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr int kFewestSteps = 3;
constexpr int kShortestPeriod = 4; // pixels

} // namespace

cv::Mat phaseShiftPattern(cv::Size size, PatternAxis axis, int periods, int step, int steps) {
    if (size.width < 1 || size.height < 1)
        throw InvalidInput("projector size", "a pattern needs at least one pixel", "give width and height in pixels");
    const int length = axis == PatternAxis::columns ? size.width : size.height;
    if (steps < kFewestSteps || step < 0 || step >= steps)
        throw InvalidInput("phase shift", "step " + std::to_string(step) + " of " + std::to_string(steps),
                           "use three steps or more, counted from 0");
    if (periods < 1 || periods * kShortestPeriod > length)
        throw InvalidInput("phase shift", std::to_string(periods) + " periods on " + std::to_string(length) + " pixels",
                           "use 1 to " + std::to_string(length / kShortestPeriod) + " periods");
    cv::Mat line(1, length, CV_8U);
    for (int n = 0; n < length; ++n) {
        const double turns = periods * (n + 0.5) / length - static_cast<double>(step) / steps;
        line.at<uchar>(n) = cv::saturate_cast<uchar>(127.5 + 127.5 * std::cos(2.0 * std::numbers::pi * turns));
    }
    return axis == PatternAxis::columns ? cv::repeat(line, size.height, 1) : cv::repeat(line.t(), 1, size.width);
}

} // namespace lumorph
