#include "calibration/capture/picture_light.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace lumorph {

namespace {

constexpr double kBlur = 2.0; ///< pixels
constexpr double kBrightest = 0.99;
constexpr double kWanted = 200.0, kTolerance = 30.0; ///< grey of the brightest
constexpr double kFirst = 1.0 / 60.0;                ///< seconds that are tried first
constexpr double kRefresh = 1.0 / 60.0;
constexpr int kMostTries = 12;
constexpr double kClippedStep = 0.4; ///< how much longer it was is not known
constexpr double kLargestStep = 8.0;
constexpr double kTelling = 10.0; ///< greys that a step should change at least, for it to be missed

double energyOf(const cv::Mat1f& picture) {
    cv::Mat1f x, y;
    cv::Sobel(picture, x, CV_32F, 1, 0);
    cv::Sobel(picture, y, CV_32F, 0, 1);
    return x.dot(x) + y.dot(y);
}

double inWholeRefreshes(double seconds) {
    return seconds < kRefresh ? seconds : std::floor(seconds / kRefresh + 1e-6) * kRefresh;
}

} // namespace

PictureLight lightOf(const cv::Mat& grey) {
    PictureLight light;
    std::array<int, 256> count{};
    for (int y = 0; y < grey.rows; ++y)
        for (const uchar* at = grey.ptr(y); at != grey.ptr(y) + grey.cols; ++at) ++count[*at];
    const double share = 1.0 / std::max<double>(1.0, static_cast<double>(grey.total()));
    double below = 0.0;
    for (std::size_t value = 0; value < count.size(); ++value) {
        const double part = share * count[value];
        light.histogram[value / 4] += static_cast<float>(part);
        if (below < kBrightest) light.bright = static_cast<double>(value);
        below += part;
        if (static_cast<int>(value) >= PictureLight::kClipped) light.clipped += part;
    }
    cv::Mat1f sharp, blurred;
    grey.convertTo(sharp, CV_32F);
    cv::GaussianBlur(sharp, blurred, {}, kBlur);
    const double coarse = energyOf(blurred);
    light.sharpness = coarse > 0.0 ? energyOf(sharp) / coarse : 0.0;
    return light;
}

std::optional<double> findExposure(CaptureCamera& camera, const Progress& progress) {
    const auto can = camera.exposures();
    if (!can) return std::nullopt;
    const auto brightAt = [&](double seconds) {
        camera.setExposure(seconds);
        (void)camera.grab(progress); // some cameras apply it one frame later
        return lightOf(greyOf(camera.grab(progress))).bright;
    };
    double seconds = std::clamp(kFirst, can->shortest, can->longest);
    double bright = brightAt(seconds);
    for (int k = 0; k < kMostTries && std::abs(bright - kWanted) > kTolerance; ++k) {
        const double step =
            bright >= PictureLight::kClipped ? kClippedStep : std::min(kLargestStep, kWanted / std::max(1.0, bright));
        const double next = std::clamp(inWholeRefreshes(step * seconds), can->shortest, can->longest);
        if (std::abs(next / seconds - 1.0) < 0.01) break; // as long or as short as it can
        const double then = brightAt(next);
        const bool isTelling = bright < PictureLight::kClipped && std::abs(next / seconds - 1.0) * bright > kTelling;
        const bool reacts = !isTelling || std::abs(then - bright) > 1.0;
        seconds = next;
        bright = then;
        if (!reacts) return std::nullopt;
    }
    return seconds;
}

} // namespace lumorph
