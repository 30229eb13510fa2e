#include "calibration/light/camera_light.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr int kWidth = 320;             // pixels of its pictures
constexpr int kFramesAfterExposure = 4; // until a driver has taken a new exposure over
constexpr double kCoveredShare = 0.02;  // of a projector's light that is left behind a covered lens
constexpr double kOpenShare = 0.8;      // of it that is seen again
constexpr Microseconds kLongestCover{60'000'000};
constexpr int kMostLooks = 2000; // of one wait, where a clock stands still

cv::Mat flatPicture(cv::Size size, const glm::ivec3& color) {
    return {size, CV_8UC3, cv::Scalar(color.b, color.g, color.r)};
}

/// Red, green and blue, or grey as it is; at most `kWidth` wide.
cv::Mat smallPicture(const cv::Mat& picture) {
    cv::Mat small, colour;
    if (picture.cols > kWidth) {
        const int height = static_cast<int>(std::lround(static_cast<double>(kWidth) * picture.rows / picture.cols));
        cv::resize(picture, small, {kWidth, height}, 0.0, 0.0, cv::INTER_AREA);
    } else {
        small = picture;
    }
    if (small.channels() == 1) return small.clone();
    cv::cvtColor(small, colour, cv::COLOR_BGR2RGB);
    return colour;
}

} // namespace

CameraLight::CameraLight(CaptureCamera& camera, std::vector<PatternDisplay*> displays, std::vector<std::string> names,
                         const Progress& progress, std::shared_ptr<const Clock> clock)
    : camera_(camera), displays_(std::move(displays)), names_(std::move(names)), progress_(progress),
      clock_(std::move(clock)), covered_(displays_.size(), false) {
    const auto exposures = camera_.exposures();
    if (!exposures)
        throw DeviceError("camera " + camera_.name(), "its exposure cannot be set from here",
                          "measure light with a camera whose driver has absolute exposure");
    exposures_ = *exposures;
    const auto lit = std::ranges::find_if(displays_, [](const PatternDisplay* display) { return display != nullptr; });
    if (lit == displays_.end()) throw InvalidInput("measurement of light", "no projector is on", "switch one on");
    PoseCaptureSettings settings;
    settings.order = parsePattern("graycode", (*lit)->size());
    settings.clock = clock_;
    settle_ = PoseCapture(camera_, **lit, settings).measureSettle(progress_).delay;
}

CameraLight::~CameraLight() {
    for (PatternDisplay* display : displays_)
        if (display) display->clear();
}

void CameraLight::expose(double seconds) {
    const double wanted = std::clamp(seconds, exposures_.shortest, exposures_.longest);
    if (wanted == exposure_) return;
    camera_.setExposure(wanted);
    exposure_ = wanted;
    for (int frame = 0; frame < kFramesAfterExposure; ++frame) (void)camera_.grab(progress_);
}

void CameraLight::show(const LightShow& show) {
    for (std::size_t p = 0; p < displays_.size(); ++p)
        if (displays_[p])
            displays_[p]->show(flatPicture(displays_[p]->size(), show.at(p).value_or(glm::ivec3(0))), progress_);
}

cv::Mat CameraLight::look() {
    const Microseconds shown = clock_->now();
    const Microseconds wait = settle_ + Microseconds(static_cast<std::int64_t>(1e6 * exposure_));
    cv::Mat picture = camera_.grab(progress_);
    for (int looks = 0; clock_->now() - shown <= wait && looks < kMostLooks; ++looks) picture = camera_.grab(progress_);
    return smallPicture(camera_.grab(progress_));
}

/// What this projector's white adds to each pixel.
cv::Mat CameraLight::lightOf(std::size_t projector) {
    LightShow all(displays_.size(), glm::ivec3(0));
    show(all);
    cv::Mat dark = look(), lit, added;
    all[projector] = glm::ivec3(255);
    show(all);
    lit = look();
    cv::subtract(lit, dark, added, cv::noArray(), CV_MAKETYPE(CV_32F, lit.channels()));
    return added;
}

/// A share of the light, so that noise of dark pixels counts for nothing.
void CameraLight::waitFor(std::size_t projector, bool covered) {
    const auto [found, isFirst] = whole_.try_emplace(projector);
    auto& [whole, seconds] = found->second;
    if (isFirst) whole = lightOf(projector), seconds = exposure_;
    expose(seconds); // else its light is another share of the whole
    const Microseconds begun = clock_->now();
    for (int looks = 0;; ++looks) {
        progress_.report(-1.0, (covered ? "cover the lens of " : "uncover the lens of ") + names_.at(projector));
        const double share = lightOf(projector).dot(whole) / std::max(whole.dot(whole), 1e-9);
        if (covered ? share < kCoveredShare : share > kOpenShare) break;
        if (clock_->now() - begun > kLongestCover || looks > kMostLooks)
            throw DeviceError(names_.at(projector), covered ? "its lens was not covered" : "its lens stayed covered",
                              "measure again, and do as it says within a minute");
    }
    covered_[projector] = covered;
}

cv::Mat CameraLight::photograph(const LightShow& colors, double seconds) {
    expose(seconds);
    for (std::size_t p = 0; p < displays_.size(); ++p)
        if (displays_[p] && covered_[p] == colors.at(p).has_value()) waitFor(p, !colors[p].has_value());
    expose(seconds);
    show(colors);
    return look();
}

} // namespace lumorph
