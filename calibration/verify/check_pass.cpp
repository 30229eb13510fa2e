#include "calibration/verify/check_pass.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "calibration/decode/pattern_decoder.h"
#include "calibration/doctor/sequence_check.h"
#include "calibration/solve/device_calibration.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr int kMostPoints = 6000;
constexpr double kDark = 14.0; // grey levels that 99 % of the pixels stay below
constexpr double kLitBy = 5.0; // grey levels between black and white
constexpr double kClippedGrey = 254.0;
constexpr double kFewestLit = 0.05; // shares of the pixels that should be lit
constexpr double kMostClipped = 0.25;
constexpr double kFewestRead = 0.55;
constexpr double kCoarser = 3.5; // times as coarse as the camera's pixels: stripes are lost to blur
constexpr double kFaint = 0.22;  // contrast of the finest stripes
constexpr std::size_t kFewestExpected = 40;
constexpr double kFewestOfDevice = 15.0; // pixels that tell whether it is seen

NoVerdict because(Obstacle obstacle, std::string why, std::string remedy) {
    return {obstacle, std::move(why), std::move(remedy)};
}

double percentile(const cv::Mat1b& image, double share) {
    std::vector<uchar> values;
    for (int y = 0; y < image.rows; y += 2)
        for (int x = 0; x < image.cols; x += 2) values.push_back(image(y, x));
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::ranges::nth_element(values, at);
    return *at;
}

bool isComplete(const std::vector<cv::Mat>& images, const CaptureOrder& order) {
    if (images.size() != order.images.size() || images.empty()) return false;
    return std::ranges::all_of(images, [&](const cv::Mat& image) {
        return !image.empty() && image.type() == CV_8U && image.size() == images.front().size();
    });
}

/// Shares of what should be lit, of all or of the device alone.
struct SeenLightShares {
    double count = 0.0, lit = 0.0, clipped = 0.0, read = 0.0, contrast = 1.0;
};

SeenLightShares sharesOf(const DecodedView& view, const ExpectedLight& expected, bool deviceAlone) {
    SeenLightShares shares;
    std::vector<float> contrasts;
    for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
        if (deviceAlone && !expected.onDevice[i]) continue;
        const cv::Point& at = expected.pixels[i];
        shares.count += 1.0;
        shares.lit += view.white(at) - view.black(at) > kLitBy ? 1.0 : 0.0;
        shares.clipped += view.white(at) >= kClippedGrey ? 1.0 : 0.0;
        if (!std::isfinite(view.column(at)) || !std::isfinite(view.row(at))) continue;
        shares.read += 1.0;
        contrasts.push_back(view.confidence(at));
    }
    for (double* share : {&shares.lit, &shares.clipped, &shares.read}) *share /= std::max(1.0, shares.count);
    if (contrasts.empty()) return shares;
    const auto middle = contrasts.begin() + static_cast<std::ptrdiff_t>(contrasts.size() / 2);
    std::ranges::nth_element(contrasts, middle);
    shares.contrast = *middle;
    return shares;
}

std::optional<NoVerdict> obstacleIn(const DecodedView& view, const ExpectedLight& expected) {
    if (percentile(view.white, 0.99) < kDark)
        return because(Obstacle::tooDark, "the camera sees nothing",
                       "take the cap off its lens, switch the projector on, or expose longer");
    const SeenLightShares shares = sharesOf(view, expected, false), device = sharesOf(view, expected, true);
    if (shares.lit < kFewestLit)
        return because(Obstacle::noLight, "the camera sees none of the projector's light where it should fall",
                       "look whether the projector shines and the camera looks at the device");
    if (shares.clipped > kMostClipped)
        return because(Obstacle::overexposed, "much of the light is overexposed", "expose the camera less");
    const bool isDeviceHidden = device.count >= kFewestOfDevice && device.lit < kFewestRead;
    if (shares.lit < kFewestRead || isDeviceHidden)
        return because(Obstacle::covered, "something covers what the camera should see of the light",
                       "step back, and take hands and things away");
    // Where there is light but its stripes cannot be read, they run into one another.
    const double cells = std::max(view.columnCell, view.rowCell);
    const double finest = std::exp2(std::ceil(std::log2(std::max(1.0, expected.panelPixels))));
    if (cells > kCoarser * finest || shares.contrast < kFaint || shares.read < kFewestRead * shares.lit)
        return because(Obstacle::blurred, "the camera's picture is blurred", "focus it, and clean its lens");
    return std::nullopt;
}

} // namespace

std::string_view keyOf(Obstacle obstacle) {
    switch (obstacle) {
    case Obstacle::cameraLost:
        return "camera_lost";
    case Obstacle::tooDark:
        return "too_dark";
    case Obstacle::noLight:
        return "no_light";
    case Obstacle::overexposed:
        return "overexposed";
    case Obstacle::covered:
        return "covered";
    case Obstacle::blurred:
        return "blurred";
    case Obstacle::unsteady:
        return "unsteady";
    case Obstacle::unexplained:
        return "unexplained";
    }
    return "";
}

std::string sentenceOf(const NoVerdict& reason) { return reason.why + "; " + reason.remedy + "."; }

ExpectedLight expectedLight(const Rig& rig, const Installation& believed, std::span<const double> strokes,
                            std::size_t projector, std::size_t camera, int step) {
    const CalibratedCamera& eye = believed.cameras.at(camera).camera;
    const CalibratedCamera& lamp = believed.projectors.at(projector).camera;
    const RoomSurface surface(believed, rig, strokes);
    bool isOnDevice = false;
    const auto panelAt = [&](double x, double y) -> std::optional<glm::dvec2> {
        const auto hit = surface.trace(positionOf(eye), directionOf(eye, {x, y}));
        if (!hit || !surface.sees(*hit, positionOf(lamp))) return std::nullopt;
        isOnDevice = hit->isOnDevice;
        const auto pixel = pixelOf(lamp, hit->point);
        const bool inside = pixel && pixel->x >= 0.0 && pixel->y >= 0.0 && pixel->x <= lamp.size.x - 1.0 &&
                            pixel->y <= lamp.size.y - 1.0;
        return inside ? pixel : std::nullopt;
    };
    ExpectedLight expected;
    expected.picture = {eye.size.x, eye.size.y};
    std::vector<double> ratios;
    for (int y = step / 2; y < eye.size.y; y += step)
        for (int x = step / 2; x < eye.size.x; x += step) {
            const auto here = panelAt(x, y);
            if (!here) continue;
            expected.pixels.emplace_back(x, y);
            expected.onDevice.push_back(isOnDevice);
            if (const auto beside = panelAt(x + 1, y)) ratios.push_back(glm::length(*beside - *here));
        }
    if (ratios.empty()) return expected;
    const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
    std::ranges::nth_element(ratios, middle);
    expected.panelPixels = *middle;
    return expected;
}

ReadPass readPass(const std::vector<cv::Mat>& images, const CaptureOrder& order, const ExpectedLight& expected,
                  std::size_t projector) {
    ReadPass pass;
    if (!isComplete(images, order)) {
        pass.obstacle = because(Obstacle::cameraLost, "the camera gave no pictures, or stopped in between",
                                "look whether it is plugged in, and check again");
        return pass;
    }
    if (images.front().size() != expected.picture) {
        pass.obstacle =
            because(Obstacle::cameraLost, "the camera's pictures have another size than it was calibrated with",
                    "set it to " + std::to_string(expected.picture.width) + " x " +
                        std::to_string(expected.picture.height) + ", or calibrate it again");
        return pass;
    }
    if (expected.pixels.size() < kFewestExpected) {
        pass.obstacle = because(Obstacle::noLight, "as the room is believed to be, the camera sees hardly any light",
                                "calibrate the room again");
        return pass;
    }
    const DecodedView view = decodeView(images, order);
    pass.obstacle = obstacleIn(view, expected);
    if (pass.obstacle) return pass;
    CapturedView names{"check", {}};
    for (std::size_t i = 0; i < images.size(); ++i) names.files.emplace_back("image " + std::to_string(i + 1));
    if (const auto wrong = checkSequence(names, images, order)) {
        pass.obstacle = because(Obstacle::unsteady, wrong->why, "keep still, and check again");
        return pass;
    }
    for (const ProjectorPoint& point : lightOf(view, kMostPoints))
        pass.points.push_back({projector, {point.camera.x, point.camera.y}, {point.projector.x, point.projector.y}});
    return pass;
}

} // namespace lumorph
