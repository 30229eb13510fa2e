#include "calibration/lab/lab_light.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"

namespace lumorph {
namespace {

std::array<float, 256> lightOfBytes(double gamma) {
    std::array<float, 256> light{};
    for (std::size_t i = 0; i < light.size(); ++i) {
        const double value = static_cast<double>(i) / 255.0;
        light[i] = static_cast<float>(gamma == 0.0 ? lightOfSrgb(value) : std::pow(value, gamma));
    }
    return light;
}

/// Linearly between the points of a curve. The lab computes by itself what the renderer inverts.
glm::vec3 lightOnCurve(const std::vector<InstalledProjector::ResponsePoint>& curve, double value) {
    for (std::size_t k = 1; k < curve.size(); ++k) {
        if (curve[k].value < value) continue;
        const double share = (value - curve[k - 1].value) / (curve[k].value - curve[k - 1].value);
        return curve[k - 1].light + static_cast<float>(share) * (curve[k].light - curve[k - 1].light);
    }
    return curve.back().light;
}

} // namespace

double lightOfSrgb(double value) noexcept {
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

glm::vec3 lightOfSrgb(const glm::vec3& color) noexcept {
    return {lightOfSrgb(color.r), lightOfSrgb(color.g), lightOfSrgb(color.b)};
}

double srgbOfLight(double light) noexcept {
    const double inside = std::clamp(light, 0.0, 1.0);
    return inside <= 0.0031308 ? 12.92 * inside : 1.055 * std::pow(inside, 1.0 / 2.4) - 0.055;
}

LabPicture labPicture(const Image& image, double gamma, const glm::vec3& gain) {
    const std::array<float, 256> light = lightOfBytes(gamma);
    LabPicture picture{image.size(), {}};
    picture.light.reserve(image.pixels().size());
    for (const Image::Pixel& pixel : image.pixels())
        picture.light.push_back(gain * glm::vec3(light[pixel[0]], light[pixel[1]], light[pixel[2]]));
    return picture;
}

LabPicture labPicture(const Image& image, const InstalledProjector& projector) {
    if (projector.responseCurve.empty() && projector.black == glm::vec3(0.0F))
        return labPicture(image, projector.gamma, projector.gain);
    const std::array<float, 256> formula = lightOfBytes(projector.gamma);
    std::array<glm::vec3, 256> light{};
    for (std::size_t i = 0; i < light.size(); ++i) {
        const glm::vec3 above = projector.responseCurve.empty()
                                    ? glm::vec3(formula[i])
                                    : lightOnCurve(projector.responseCurve, static_cast<double>(i) / 255.0);
        light[i] = projector.gain * (projector.black + (1.0F - projector.black) * above);
    }
    LabPicture picture{image.size(), {}};
    picture.light.reserve(image.pixels().size());
    for (const Image::Pixel& pixel : image.pixels())
        picture.light.emplace_back(light[pixel[0]].r, light[pixel[1]].g, light[pixel[2]].b);
    return picture;
}

glm::vec3 lightAt(const LabPicture& picture, const glm::vec2& pixel) noexcept {
    const float x = std::clamp(pixel.x, 0.0F, static_cast<float>(picture.size.x - 1));
    const float y = std::clamp(pixel.y, 0.0F, static_cast<float>(picture.size.y - 1));
    const int left = static_cast<int>(x);
    const int top = static_cast<int>(y);
    const int right = std::min(left + 1, picture.size.x - 1);
    const int bottom = std::min(top + 1, picture.size.y - 1);
    const float across = x - static_cast<float>(left);
    const float down = y - static_cast<float>(top);
    const auto at = [&](int column, int row) -> const glm::vec3& {
        return picture.light[static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.size.x) +
                             static_cast<std::size_t>(column)];
    };
    return (1.0F - down) * ((1.0F - across) * at(left, top) + across * at(right, top)) +
           down * ((1.0F - across) * at(left, bottom) + across * at(right, bottom));
}

Image labImage(const std::vector<glm::vec3>& radiance, glm::ivec2 size) {
    Image image(size);
    if (radiance.size() != image.pixels().size())
        throw InvalidInput("picture of the lab", "its light and its size do not agree", "give one value a pixel");
    for (std::size_t i = 0; i < radiance.size(); ++i)
        for (int channel = 0; channel < 3; ++channel)
            image.pixels()[i][static_cast<std::size_t>(channel)] =
                static_cast<std::uint8_t>(std::lround(255.0 * srgbOfLight(static_cast<double>(radiance[i][channel]))));
    return image;
}

} // namespace lumorph
