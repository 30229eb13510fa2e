#include "app/applications/ambient/forecast_card.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <string>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "core/render/figure/text.h"

namespace lumorph::ambient {
namespace {

constexpr double kFalls = 0.1;                   ///< mm of rain, or cm of snow, an hour
constexpr double kFoggy = 1000.0;                ///< metres of visibility
constexpr double kOvercast = 0.75, kFair = 0.30; ///< shares of the sky

constexpr glm::vec3 kPlateColor{0.05F, 0.09F, 0.18F}, kTextColor{1.0F, 1.0F, 1.0F}, kHourColor{0.74F, 0.86F, 1.0F};
constexpr glm::vec3 kSunColor{1.0F, 0.80F, 0.18F}, kMoonColor{0.93F, 0.93F, 0.80F}, kCloudColor{0.90F, 0.93F, 0.97F};
constexpr glm::vec3 kDarkCloud{0.60F, 0.66F, 0.75F}, kDropColor{0.36F, 0.70F, 1.0F}, kBoltColor{1.0F, 0.86F, 0.25F};
constexpr float kPlateCorner = 22.0F, kHourEm = 46.0F, kDegreesEm = 56.0F;
constexpr float kHourLine = 48.0F, kDegreesLine = 192.0F; ///< baselines, pixels from the top
constexpr glm::vec2 kSignAt{80.0F, 100.0F};

/// Pixels outside a shape, negative within.
using Distance = std::function<float(const glm::vec2&)>;

Distance disc(const glm::vec2& centre, float radius) {
    return [=](const glm::vec2& at) { return glm::distance(at, centre) - radius; };
}

/// A line with round ends.
Distance stroke(const glm::vec2& from, const glm::vec2& to, float half) {
    return [=](const glm::vec2& at) {
        const glm::vec2 along = to - from, way = at - from;
        const float share = glm::clamp(glm::dot(way, along) / glm::dot(along, along), 0.0F, 1.0F);
        return glm::distance(way, share * along) - half;
    };
}

Distance with(Distance a, Distance b) {
    return [a = std::move(a), b = std::move(b)](const glm::vec2& at) { return std::min(a(at), b(at)); };
}

Distance without(Distance a, Distance b) {
    return [a = std::move(a), b = std::move(b)](const glm::vec2& at) { return std::max(a(at), -b(at)); };
}

void paint(Image& image, const Distance& shape, const glm::vec3& color) {
    for (int y = 0; y < image.size().y; ++y)
        for (int x = 0; x < image.size().x; ++x) {
            const float share = glm::clamp(0.5F - shape(glm::vec2(x, y) + 0.5F), 0.0F, 1.0F);
            if (share <= 0.0F) continue;
            Image::Pixel& pixel = image.at(x, y);
            for (std::size_t c = 0; c < 3; ++c) {
                const float before = static_cast<float>(pixel[c]), after = 255.0F * color[static_cast<int>(c)];
                pixel[c] = static_cast<std::uint8_t>(std::lround(glm::mix(before, after, share)));
            }
        }
}

void paintSun(Image& image, const glm::vec2& at, float radius) {
    paint(image, disc(at, radius), kSunColor);
    for (int k = 0; k < 8; ++k) {
        const float angle = std::numbers::pi_v<float> * static_cast<float>(k) / 4.0F;
        const glm::vec2 out(std::cos(angle), std::sin(angle));
        paint(image, stroke(at + 1.38F * radius * out, at + 1.75F * radius * out, 3.4F), kSunColor);
    }
}

void paintMoon(Image& image, const glm::vec2& at, float radius) {
    paint(image, without(disc(at, radius), disc(at + radius * glm::vec2(0.50F, -0.30F), 0.88F * radius)), kMoonColor);
}

/// About its middle, `size` pixels to each side; with a dark rim that sets it off from what is behind.
void paintCloud(Image& image, const glm::vec2& at, float size, const glm::vec3& color) {
    const auto shape = [&](float more) {
        const auto puff = [&](float x, float y, float radius) {
            return disc(at + size * glm::vec2(x, y), size * radius + more);
        };
        return with(with(puff(-0.52F, 0.08F, 0.36F), puff(0.02F, -0.16F, 0.50F)),
                    with(puff(0.58F, 0.10F, 0.34F), stroke(at + size * glm::vec2(-0.5F, 0.20F),
                                                           at + size * glm::vec2(0.56F, 0.20F), 0.24F * size + more)));
    };
    paint(image, shape(5.0F), kPlateColor);
    paint(image, shape(0.0F), color);
}

void paintDrops(Image& image) {
    for (const float x : {-27.0F, 0.0F, 27.0F})
        paint(image, stroke(kSignAt + glm::vec2(x + 3.0F, 19.0F), kSignAt + glm::vec2(x - 6.0F, 40.0F), 4.6F),
              kDropColor);
}

void paintFlakes(Image& image) {
    for (const float x : {-29.0F, 0.0F, 29.0F}) {
        const glm::vec2 middle = kSignAt + glm::vec2(x, x == 0.0F ? 36.0F : 28.0F);
        for (int k = 0; k < 3; ++k) {
            const float angle = std::numbers::pi_v<float> * (static_cast<float>(k) / 3.0F + 0.5F);
            const glm::vec2 out = 10.0F * glm::vec2(std::cos(angle), std::sin(angle));
            paint(image, stroke(middle - out, middle + out, 2.1F), kTextColor);
        }
    }
}

void paintBolt(Image& image) {
    const glm::vec2 a = kSignAt + glm::vec2(8.0F, 10.0F), b = kSignAt + glm::vec2(-10.0F, 27.0F),
                    c = kSignAt + glm::vec2(6.0F, 27.0F), d = kSignAt + glm::vec2(-8.0F, 46.0F);
    paint(image, with(with(stroke(a, b, 8.5F), stroke(b, c, 8.5F)), stroke(c, d, 8.0F)), kPlateColor);
    paint(image, with(with(stroke(a, b, 4.4F), stroke(b, c, 4.4F)), stroke(c, d, 4.0F)), kBoltColor);
}

void paintFog(Image& image) {
    struct Swathe {
        float y, from, to;
    };
    for (const Swathe& one :
         {Swathe{-30.0F, -30.0F, 38.0F}, {-10.0F, -46.0F, 26.0F}, {10.0F, -28.0F, 46.0F}, {30.0F, -42.0F, 30.0F}})
        paint(image, stroke(kSignAt + glm::vec2(one.from, one.y), kSignAt + glm::vec2(one.to, one.y), 5.2F),
              kCloudColor);
}

void paintSign(Image& image, WeatherSign sign) {
    const glm::vec2 high = kSignAt + glm::vec2(0.0F, -14.0F), behind = kSignAt + glm::vec2(20.0F, -20.0F);
    switch (sign) {
    case WeatherSign::sun:
        return paintSun(image, kSignAt, 23.0F);
    case WeatherSign::moon:
        return paintMoon(image, kSignAt, 32.0F);
    case WeatherSign::sunAndCloud:
        paintSun(image, behind, 17.0F);
        return paintCloud(image, kSignAt + glm::vec2(-8.0F, 12.0F), 44.0F, kCloudColor);
    case WeatherSign::moonAndCloud:
        paintMoon(image, behind, 22.0F);
        return paintCloud(image, kSignAt + glm::vec2(-8.0F, 12.0F), 44.0F, kCloudColor);
    case WeatherSign::cloud:
        return paintCloud(image, kSignAt, 56.0F, kCloudColor);
    case WeatherSign::fog:
        return paintFog(image);
    case WeatherSign::rain:
        paintCloud(image, high, 52.0F, kDarkCloud);
        return paintDrops(image);
    case WeatherSign::snow:
        paintCloud(image, high, 52.0F, kCloudColor);
        return paintFlakes(image);
    case WeatherSign::thunder:
        paintCloud(image, high, 52.0F, kDarkCloud);
        return paintBolt(image);
    }
}

void writeMiddle(Image& image, const Font& font, const std::string& text, float line, float em,
                 const glm::vec3& color) {
    font.write(image, text, {0.5F * (static_cast<float>(kCardPixels.x) - font.width(text, em)), line}, em, color);
}

} // namespace

WeatherSign signOf(const WeatherHour& weather, bool day) noexcept {
    if (weather.thunder > 0.5) return WeatherSign::thunder;
    if (weather.snow > kFalls && weather.snow > weather.rain) return WeatherSign::snow;
    if (weather.rain > kFalls) return WeatherSign::rain;
    if (weather.visibility < kFoggy) return WeatherSign::fog;
    if (weather.cloudCover > kOvercast) return WeatherSign::cloud;
    if (weather.cloudCover > kFair) return day ? WeatherSign::sunAndCloud : WeatherSign::moonAndCloud;
    return day ? WeatherSign::sun : WeatherSign::moon;
}

Image pictureOf(const ForecastCard& card, const Font& font) {
    const auto byte = [](float share) { return static_cast<std::uint8_t>(std::lround(255.0F * share)); };
    Image image(kCardPixels, {byte(kPlateColor.x), byte(kPlateColor.y), byte(kPlateColor.z), 0});
    const glm::vec2 half = 0.5F * glm::vec2(kCardPixels);
    for (int y = 0; y < image.size().y; ++y)
        for (int x = 0; x < image.size().x; ++x) {
            const glm::vec2 out =
                glm::max(glm::abs(glm::vec2(x, y) + 0.5F - half) - (half - kPlateCorner - 2.0F), 0.0F);
            image.at(x, y)[3] = byte(0.94F * glm::clamp(kPlateCorner - glm::length(out) + 0.5F, 0.0F, 1.0F));
        }
    std::array<char, 16> hour{};
    std::snprintf(hour.data(), hour.size(), "%d:00", card.hour);
    writeMiddle(image, font, hour.data(), kHourLine, kHourEm, kHourColor);
    paintSign(image, card.sign);
    // A minus sign as wide as digits, and the degree's ring beside the middle.
    const std::string degrees = (card.degrees < 0 ? "\u2212" : "") + std::to_string(std::abs(card.degrees)) + "\u00B0";
    writeMiddle(image, font, degrees, kDegreesLine, kDegreesEm, kTextColor);
    return image;
}

} // namespace lumorph::ambient
