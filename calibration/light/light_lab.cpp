#include "calibration/light/light_lab.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include "calibration/lab/board_lab.h"
#include "calibration/lab/lab_light.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr std::array<std::string_view, 6> kLightFaults = {"saturated", "dark",    "automatic",
                                                          "ambient",   "falling", "unseen"};
constexpr double kUsualSeconds = 1.0 / 40.0; // at which full white nearly fills the sensor
constexpr double kBrightestShare = 0.98;     // of the lit pixels
constexpr int kByteSteps = 8192;
constexpr int kLampAfter = 120;     // photographs, when a lamp is switched on
constexpr double kLamp = 0.02;      // of white
constexpr double kMeanWanted = 0.2; // light of the sensor that an automatic exposure is after

/// Byte of the sensor's light in [0, 1].
double developed(double light, const LightLabOptions& options) {
    const double root = 1.0 / options.gamma, low = std::pow(options.toe, root);
    double value =
        (std::pow(std::clamp(light, 0.0, 1.0) + options.toe, root) - low) / (std::pow(1.0 + options.toe, root) - low);
    value += options.shoulder * value * (1.0 - value);
    return options.pedestal + (255.0 - options.pedestal) * value;
}

/// Turned away by a third of a turn about the vertical axis through itself.
CalibratedCamera lookingAside(const CalibratedCamera& camera) {
    const glm::dvec3 place = positionOf(camera);
    CalibratedCamera aside = camera;
    aside.cameraFromWorld =
        cameraLookingAt(place, place + glm::dvec3(1.0, -0.2, 0.3), camera.size, camera.focal.x).cameraFromWorld;
    return aside;
}

} // namespace

LightFault parseLightFault(std::string_view text) {
    const auto found = std::ranges::find(kLightFaults, text);
    if (found == kLightFaults.end())
        throw InvalidInput("fault \"" + std::string(text) + "\"", "light has no such fault",
                           "use saturated, dark, automatic, ambient, falling or unseen");
    return static_cast<LightFault>(found - kLightFaults.begin());
}

LightLab::LightLab(const Installation& truth, const Rig& rig, const CalibratedCamera& camera,
                   const std::optional<WhiteSheet>& sheet, const LightLabOptions& options, std::uint32_t seed)
    : truth_(truth), options_(options), size_(camera.size), seed_(seed) {
    if (truth.projectors.empty())
        throw InvalidInput("light in the lab", "its room has no projector", "add and calibrate one first");
    if (options.fault == LightFault::falling) {
        InstalledProjector& first = truth_.projectors.front();
        first.responseCurve = {{}, {0.5, glm::vec3(0.4F)}, {0.65, glm::vec3(0.3F)}, {1.0, glm::vec3(1.0F)}};
    }
    LabWorld world = lightWorld(truth_, rig, sheet);
    for (LabProjector& lamp : world.projectors) { // by plain white; what values make of it is `sent`
        lamp.projector.gain = glm::vec3(1.0F);
        lamp.projector.black = glm::vec3(0.0F);
        lamp.projector.responseCurve.clear();
    }
    world.ambient = glm::vec3(0.0F);
    const std::vector<LabSurface> surfaces = world.surfaces;
    Lab lab(std::move(world));
    const LabSight sight = lab.look(camera, 2);
    for (std::size_t p = 0; p < truth_.projectors.size(); ++p) {
        const glm::ivec2 panel = truth_.projectors[p].camera.size;
        lab.show(p, Image(panel, {255, 255, 255, 255}));
        whites_.push_back(lab.radiance(sight));
        lab.show(p, Image(panel));
    }
    const auto pixels = static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y);
    const auto rays = static_cast<std::size_t>(sight.samples * sight.samples);
    std::vector<float> brightest;
    for (std::size_t i = 0; i < pixels; ++i) {
        glm::vec3 color(0.0F);
        for (std::size_t ray = i * rays; ray < (i + 1) * rays; ++ray)
            if (sight.surfaces[ray] >= 0) color += surfaces[static_cast<std::size_t>(sight.surfaces[ray])].albedo;
        const double peak = options.ambient * truth_.projectors.front().peak;
        ambient_.push_back(static_cast<float>(peak) / static_cast<float>(rays) * color);
        const glm::dvec2 half = 0.5 * glm::dvec2(size_);
        const glm::dvec2 at(static_cast<double>(i % static_cast<std::size_t>(size_.x)),
                            static_cast<double>(i / static_cast<std::size_t>(size_.x)));
        const double radius = glm::length(at + 0.5 - half) / glm::length(half);
        fading_.push_back(static_cast<float>(1.0 - options.vignetting * radius * radius));
        float light = 0.0F;
        for (const auto& white : whites_) light += white[i].g;
        if (light > 0.0F) brightest.push_back(light);
    }
    if (!brightest.empty()) {
        const auto place = brightest.begin() +
                           static_cast<std::ptrdiff_t>(kBrightestShare * static_cast<double>(brightest.size() - 1));
        std::ranges::nth_element(brightest, place);
        sensitivity_ = 1.0 / (kUsualSeconds * static_cast<double>(*place));
    }
    if (options.fault == LightFault::saturated) sensitivity_ *= 2000.0;
    if (options.fault == LightFault::dark) sensitivity_ *= 1e-3;
    for (int k = 0; k <= kByteSteps; ++k)
        bytes_.push_back(static_cast<float>(developed(static_cast<double>(k) / kByteSteps, options)));
}

glm::dvec3 LightLab::sent(std::size_t projector, const glm::ivec3& color) const {
    Image pixel(glm::ivec2(1));
    const glm::ivec3 inside = glm::clamp(color, 0, 255);
    pixel.at(0, 0) = {static_cast<std::uint8_t>(inside.r), static_cast<std::uint8_t>(inside.g),
                      static_cast<std::uint8_t>(inside.b), 255};
    return labPicture(pixel, truth_.projectors[projector]).light.front();
}

cv::Mat LightLab::photograph(const LightShow& show, double seconds) {
    if (show.size() != whites_.size())
        throw InvalidInput("light in the lab", "there is not one colour for each projector", "give one for each");
    std::vector<glm::vec3> colors(show.size(), glm::vec3(0.0F));
    for (std::size_t p = 0; p < show.size(); ++p)
        if (show[p]) colors[p] = glm::vec3(sent(p, *show[p]));
    const bool isLampOn = options_.fault == LightFault::ambient && pictures_ >= kLampAfter;
    const double lamp = isLampOn ? kLamp * truth_.projectors.front().peak : 0.0;
    const double roomPeak = options_.ambient * truth_.projectors.front().peak;
    const auto ambientBy = static_cast<float>(roomPeak > 0.0 ? 1.0 + lamp / roomPeak : 1.0);
    const auto exposure = static_cast<float>(sensitivity_ * seconds);
    const auto mixing = static_cast<float>(options_.mixing);
    const glm::vec3 balance(options_.balance);
    std::vector<glm::vec3> sensor(fading_.size());
    tbb::parallel_for(0, size_.y, [&](int y) {
        const auto width = static_cast<std::size_t>(size_.x);
        for (std::size_t i = static_cast<std::size_t>(y) * width; i < (static_cast<std::size_t>(y) + 1) * width; ++i) {
            glm::vec3 light = ambientBy * ambient_[i];
            for (std::size_t p = 0; p < colors.size(); ++p) light += colors[p] * whites_[p][i];
            const float all = light.r + light.g + light.b;
            sensor[i] = exposure * fading_[i] * balance * ((1.0F - 3.0F * mixing) * light + mixing * all);
        }
    });
    float automatic = 1.0F;
    if (options_.fault == LightFault::automatic) {
        double sum = 0.0;
        for (const glm::vec3& light : sensor) sum += static_cast<double>(light.r + light.g + light.b) / 3.0;
        automatic = static_cast<float>(kMeanWanted * static_cast<double>(sensor.size()) / std::max(sum, 1e-12));
    }
    cv::Mat levels(size_.y, 3 * size_.x, CV_32F);
    for (int y = 0; y < size_.y; ++y) {
        auto* row = levels.ptr<float>(y);
        for (int x = 0; x < size_.x; ++x)
            for (int channel = 0; channel < 3; ++channel) {
                const glm::vec3& light = sensor[static_cast<std::size_t>(y * size_.x + x)];
                const float at = std::clamp(automatic * light[channel], 0.0F, 1.0F) * kByteSteps;
                const auto below = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(kByteSteps - 1));
                const float share = at - static_cast<float>(below);
                row[3 * x + channel] = bytes_[below] + share * (bytes_[below + 1] - bytes_[below]);
            }
    }
    BoardLabOptions noise;
    noise.noise = options_.noise;
    noise.shotNoise = options_.shotNoise;
    return withNoise(levels, noise, seed_ * 65537U + pictures_++).reshape(3);
}

CalibratedCamera lightLabCamera(const Installation& truth, const LightLabOptions& options) {
    const CalibratedCamera camera = lightCamera(labCamera(truth));
    return options.fault == LightFault::unseen ? lookingAside(camera) : camera;
}

} // namespace lumorph
