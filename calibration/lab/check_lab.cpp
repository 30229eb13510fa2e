#include "calibration/lab/check_lab.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "calibration/lab/lab_photograph.h"
#include "calibration/lab/lab_world.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

double risenStroke(const MeasuredServo& servo, double commanded) {
    double stroke = commanded;
    for (std::size_t i = 0; i + 1 < servo.points.size(); ++i) {
        const MeasuredServo::Point &a = servo.points[i], &b = servo.points[i + 1];
        if (commanded < a.commanded || commanded > b.commanded) continue;
        stroke = a.rising + (b.rising - a.rising) * (commanded - a.commanded) / (b.commanded - a.commanded);
    }
    return std::clamp(stroke, 0.0, 1.0);
}

LabWorld shownWorld(const Installation& truth, const Rig& rig, std::span<const double> strokes,
                    const CheckLabOptions& options) {
    LabWorld world = roomWorld(truth, rig, strokes);
    world.blockers = options.hands;
    double peak = 0.0;
    for (const InstalledProjector& projector : truth.projectors) {
        if (projector.enabled) peak = std::max(peak, projector.peak);
        world.projectors.push_back({options.isLinear ? linearProjector(projector) : projector, {}});
    }
    world.ambient = glm::vec3(static_cast<float>(options.pictures.ambient * peak));
    return world;
}

} // namespace

std::vector<double> risenStrokes(const Installation& truth, const Rig& rig, std::span<const double> commanded) {
    std::vector<double> strokes(commanded.begin(), commanded.end());
    if (strokes.size() != rig.actuatorCount())
        throw InvalidInput("strokes of the device", "they are not one for each actuator of the rig",
                           "give " + std::to_string(rig.actuatorCount()) + " of them");
    for (std::size_t i = 0; i < strokes.size(); ++i) {
        const auto servo = std::ranges::find(truth.servos, rig.actuators()[i].name, &MeasuredServo::actuator);
        if (servo != truth.servos.end()) strokes[i] = risenStroke(*servo, strokes[i]);
    }
    return strokes;
}

CheckLab::CheckLab(const Installation& truth, const Rig& rig, std::span<const double> commanded,
                   const CheckLabOptions& options, std::uint32_t seed)
    : options_(options), seed_(seed) {
    if (truth.projectors.empty() || truth.cameras.empty())
        throw InvalidInput("check in the lab", "its room has no projector or no camera", "add one in the studio");
    const std::vector<double> strokes = risenStrokes(truth, rig, commanded);
    for (const InstalledProjector& projector : truth.projectors) dark_.emplace_back(projector.camera.size);
    // The camera was set when no hand was there.
    CheckLabOptions empty = options;
    empty.hands.clear();
    lab_ = std::make_unique<Lab>(shownWorld(truth, rig, strokes, empty));
    sight_ = lab_->look(truth.cameras.front().camera, options.pictures.samples);
    exposure_ = exposureOf(*lab_, sight_, options.pictures.whiteLevel, "check in the lab");
    if (options.hands.empty()) return;
    lab_ = std::make_unique<Lab>(shownWorld(truth, rig, strokes, options));
    sight_ = lab_->look(truth.cameras.front().camera, options.pictures.samples);
}

cv::Mat CheckLab::develop() {
    cv::Mat1f light = lightIn(*lab_, sight_);
    light *= options_.exposure * exposure_;
    const double blur = std::hypot(options_.pictures.blur, options_.shake);
    if (blur > 0.0) cv::GaussianBlur(light, light, {}, blur);
    return withNoise(light, options_.pictures, seed_ * 65537U + pictures_++);
}

cv::Mat CheckLab::photograph(std::size_t projector, const cv::Mat& grey) {
    for (std::size_t i = 0; i < dark_.size(); ++i) lab_->show(i, i == projector ? pictureOf(grey) : dark_[i]);
    return develop();
}

cv::Mat CheckLab::photograph(std::span<const Image> sent) {
    if (sent.size() != dark_.size())
        throw InvalidInput("check in the lab", "there is not one picture for each projector", "give one for each");
    for (std::size_t i = 0; i < dark_.size(); ++i) lab_->show(i, sent[i]);
    return develop();
}

} // namespace lumorph
