#include "calibration/verify/show_prediction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <opencv2/imgproc.hpp>

#include "calibration/lab/board_lab.h"
#include "calibration/lab/lab_light.h"
#include "calibration/lab/lab_world.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr double kSameStroke = 0.004;

/// Light of values 0 to 255 of one projector.
std::array<float, 256> lightOfValues(const InstalledProjector& projector) {
    std::array<float, 256> light{};
    for (std::size_t i = 0; i < light.size(); ++i) {
        const double value = static_cast<double>(i) / 255.0;
        light[i] = static_cast<float>(projector.gamma > 0.0 ? std::pow(value, projector.gamma) : lightOfSrgb(value));
    }
    return light;
}

/// A sent picture as grey light, as coarse as the camera sees it.
cv::Mat1f coarseLight(const Image& picture, const InstalledProjector& projector, double coarser) {
    const std::array<float, 256> light = lightOfValues(projector);
    cv::Mat1f grey(picture.size().y, picture.size().x);
    std::ranges::transform(picture.pixels(), grey.begin(), [&](const Image::Pixel& p) {
        return 0.3F * light[p[0]] + 0.59F * light[p[1]] + 0.11F * light[p[2]];
    });
    const double factor = 1.0 / std::max(1.0, coarser);
    const cv::Size size(std::max(1, static_cast<int>(std::lround(factor * grey.cols))),
                        std::max(1, static_cast<int>(std::lround(factor * grey.rows))));
    cv::resize(grey, grey, size, 0.0, 0.0, cv::INTER_AREA);
    return grey;
}

/// The median distance in the panel between neighbours.
double coarserBy(const cv::Mat1f& share, const cv::Mat2f& panel) {
    std::vector<double> steps;
    for (int y = 0; y < share.rows; y += 2)
        for (int x = 0; x + 1 < share.cols; x += 2)
            if (share(y, x) > 0.0F && share(y, x + 1) > 0.0F) steps.push_back(cv::norm(panel(y, x + 1) - panel(y, x)));
    if (steps.empty()) return 1.0;
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::ranges::nth_element(steps, middle);
    return *middle;
}

} // namespace

ShowPrediction::ShowPrediction(const Rig& rig, const Installation& believed, int width, std::size_t camera)
    : rig_(rig), room_(believed), camera_(camera) {
    if (camera >= room_.cameras.size() || room_.projectors.empty())
        throw InvalidInput("watch of the show", "the room has no camera or no projector", "add one in the studio");
    CalibratedCamera& eye = room_.cameras[camera].camera;
    const double height = static_cast<double>(width) * eye.size.y / eye.size.x;
    if (eye.size.x > width) eye = withSize(eye, {width, static_cast<int>(std::lround(height))});
}

cv::Size ShowPrediction::size() const {
    const glm::ivec2 size = room_.cameras[camera_].camera.size;
    return {size.x, size.y};
}

const ShowSight& ShowPrediction::sight(std::span<const double> strokes) {
    const bool same = sight_.rays && std::ranges::equal(strokes, sight_.strokes, [](double a, double b) {
                          return std::abs(a - b) < kSameStroke;
                      });
    if (same) return sight_;
    sight_ = {};
    sight_.strokes.assign(strokes.begin(), strokes.end());
    sight_.rays = std::make_shared<const RoomSurface>(room_, rig_, strokes);
    LabWorld world = roomWorld(room_, rig_, strokes);
    for (const InstalledProjector& projector : room_.projectors) world.projectors.push_back({projector, {}});
    const auto albedoOf = [&](int surface) {
        const glm::vec3 albedo = world.surfaces[static_cast<std::size_t>(surface)].albedo;
        return (albedo.r + albedo.g + albedo.b) / 3.0F;
    };
    const std::array<float, 2> albedo{albedoOf(0), albedoOf(1)};
    const std::size_t lamps = room_.projectors.size();
    const LabSight rays = Lab(std::move(world)).look(room_.cameras[camera_].camera, 1);
    sight_.surface = cv::Mat1i(size());
    std::ranges::copy(rays.surfaces, sight_.surface.begin());
    for (std::size_t lamp = 0; lamp < lamps; ++lamp) {
        cv::Mat1f share(size());
        cv::Mat2f panel(size());
        for (std::size_t i = 0; i < rays.surfaces.size(); ++i) {
            const LabSight::Gleam& gleam = rays.gleams[i * lamps + lamp];
            const int surface = rays.surfaces[i];
            share(static_cast<int>(i)) = surface < 0 ? 0.0F : gleam.share * albedo[static_cast<std::size_t>(surface)];
            panel(static_cast<int>(i)) = {gleam.pixel.x, gleam.pixel.y};
        }
        sight_.coarser.push_back(coarserBy(share, panel));
        sight_.share.push_back(share);
        sight_.panel.push_back(panel);
    }
    return sight_;
}

CoarseShow ShowPrediction::coarse(std::span<const Image> sent, std::span<const double> strokes) {
    if (sent.size() != room_.projectors.size())
        throw InvalidInput("watch of the show", "there is not one picture for each projector", "give one for each");
    const ShowSight& now = sight(strokes);
    CoarseShow show;
    for (std::size_t i = 0; i < sent.size(); ++i) {
        const InstalledProjector& projector = room_.projectors[i];
        cv::Mat1f& light = show.light.emplace_back();
        if (sent[i].pixels().empty() || !projector.enabled) continue;
        if (sent[i].size() != projector.camera.size)
            throw InvalidInput("watch of the show", "a picture has not its projector's size", "give what was sent");
        light = coarseLight(sent[i], projector, now.coarser[i]);
    }
    return show;
}

cv::Mat1f ShowPrediction::predict(std::span<const Image> sent, std::span<const double> strokes) {
    return predict(coarse(sent, strokes), strokes);
}

cv::Mat1f ShowPrediction::predict(const CoarseShow& sent, std::span<const double> strokes) {
    const ShowSight& now = sight(strokes);
    cv::Mat1f all = cv::Mat1f::zeros(size());
    for (std::size_t i = 0; i < sent.light.size(); ++i) {
        const cv::Mat1f& light = sent.light[i];
        if (light.empty()) continue;
        const glm::ivec2 panel = room_.projectors[i].camera.size;
        const double across = static_cast<double>(light.cols) / panel.x;
        const double down = static_cast<double>(light.rows) / panel.y;
        cv::Mat2f places(size());
        std::transform(now.panel[i].begin(), now.panel[i].end(), places.begin(), [&](const cv::Vec2f& p) {
            return cv::Vec2f(static_cast<float>((static_cast<double>(p[0]) + 0.5) * across - 0.5),
                             static_cast<float>((static_cast<double>(p[1]) + 0.5) * down - 0.5));
        });
        cv::Mat1f seen;
        cv::remap(light, seen, places, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
        all += seen.mul(now.share[i]);
    }
    return all;
}

cv::Mat1f ShowPrediction::shrink(const cv::Mat& photograph) const {
    cv::Mat grey = photograph;
    if (photograph.type() == CV_8UC3) cv::cvtColor(photograph, grey, cv::COLOR_BGR2GRAY);
    const double shape = static_cast<double>(grey.cols) / std::max(1, grey.rows);
    const double expected = static_cast<double>(size().width) / size().height;
    if (grey.type() != CV_8U || std::abs(shape - expected) > 0.02 * expected)
        throw InvalidInput("camera's picture", "it has not the shape that the camera was calibrated with",
                           "set the camera to " + std::to_string(size().width) + " x " + std::to_string(size().height) +
                               " or a multiple of it");
    cv::Mat1f small;
    grey.convertTo(small, CV_32F);
    if (small.size() != size()) cv::resize(small, small, size(), 0.0, 0.0, cv::INTER_AREA);
    return small;
}

} // namespace lumorph
