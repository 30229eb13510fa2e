#include "calibration/lab/check_lab.h"

#include <algorithm>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "calibration/lab/lab_light.h"
#include "calibration/lab/lab_world.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr double kBrightestShare = 0.99; // of the pixels: what shines back more may be overexposed

Image pictureOfGrey(const cv::Mat& grey) {
    Image picture(glm::ivec2(grey.cols, grey.rows));
    for (int y = 0; y < grey.rows; ++y)
        for (int x = 0; x < grey.cols; ++x) {
            const std::uint8_t value = grey.at<std::uint8_t>(y, x);
            picture.at(x, y) = {value, value, value, 255};
        }
    return picture;
}

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
    LabWorld world;
    TriangleMesh device = deformed(rig, strokes);
    for (glm::vec3& point : device.positions) point = glm::vec3(truth.worldFromDevice * glm::vec4(point, 1.0F));
    world.surfaces = {{std::move(device), lightOfSrgb(truth.deviceColor)},
                      {tableMesh(truth.tableSize), lightOfSrgb(truth.tableColor)}};
    world.blockers = options.hands;
    double peak = 0.0;
    for (InstalledProjector projector : truth.projectors) {
        if (options.isLinear) projector.gamma = 1.0;
        if (projector.enabled) peak = std::max(peak, projector.peak);
        world.projectors.push_back({projector, Image(projector.camera.size)});
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
    for (std::size_t i = 0; i < dark_.size(); ++i) lab_->show(i, Image(dark_[i].size(), {255, 255, 255, 255}));
    cv::Mat1f white = light().reshape(1, 1);
    const auto at = white.begin() + static_cast<std::ptrdiff_t>(kBrightestShare * static_cast<double>(white.total()));
    std::nth_element(white.begin(), at, white.end());
    if (!(*at > 0.0F))
        throw InvalidInput("check in the lab", "its camera sees nothing that the projector lights",
                           "place camera and projector so that both see the device");
    exposure_ = options.pictures.whiteLevel / static_cast<double>(*at);
    if (options.hands.empty()) return;
    lab_ = std::make_unique<Lab>(shownWorld(truth, rig, strokes, options));
    sight_ = lab_->look(truth.cameras.front().camera, options.pictures.samples);
}

cv::Mat1f CheckLab::light() const {
    const std::vector<glm::vec3> radiance = lab_->radiance(sight_);
    cv::Mat1f light(sight_.size.y, sight_.size.x);
    std::ranges::transform(radiance, light.begin(),
                           [](const glm::vec3& one) { return (one.r + one.g + one.b) / 3.0F; });
    return light;
}

cv::Mat CheckLab::develop(cv::Mat1f light) {
    light *= options_.exposure * exposure_;
    const double blur = std::hypot(options_.pictures.blur, options_.shake);
    if (blur > 0.0) cv::GaussianBlur(light, light, {}, blur);
    return withNoise(light, options_.pictures, seed_ * 65537U + pictures_++);
}

cv::Mat CheckLab::photograph(std::size_t projector, const cv::Mat& grey) {
    for (std::size_t i = 0; i < dark_.size(); ++i) lab_->show(i, i == projector ? pictureOfGrey(grey) : dark_[i]);
    return develop(light());
}

cv::Mat CheckLab::photograph(std::span<const Image> sent) {
    if (sent.size() != dark_.size())
        throw InvalidInput("check in the lab", "there is not one picture for each projector", "give one for each");
    for (std::size_t i = 0; i < dark_.size(); ++i) lab_->show(i, sent[i]);
    return develop(light());
}

} // namespace lumorph
