#include "app/workspaces/scene/material_picture.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

namespace lumorph::studio {

namespace {

constexpr float kBallRadius = 0.06F; ///< metres
constexpr int kSamples = 2;          ///< a pixel, each way
const glm::vec3 kLight = glm::normalize(glm::vec3(-0.5F, 0.7F, 0.6F));

// Gamma 2 is near enough for a picture as small as a coin, and much faster.
glm::vec3 linear(const glm::vec3& color) { return color * color; }
glm::vec3 display(const glm::vec3& light) { return glm::sqrt(glm::clamp(light / (1.0F + 0.25F * light), 0.0F, 1.0F)); }

bool hasAlpha(const Image& image) {
    return std::any_of(image.pixels().begin(), image.pixels().end(),
                       [](const Image::Pixel& pixel) { return pixel[3] < 255; });
}

/// The first picture of a texture, sRGB; empty where it has none.
class Sampler {
public:
    Sampler(const SceneTexture& texture, const SceneAssets* assets) : texture_(texture) {
        if (!assets || texture.image.empty()) return;
        const auto found = assets->images.find(texture.image);
        if (found != assets->images.end() && found->second && found->second->size().x > 0) image_ = found->second.get();
    }

    [[nodiscard]] std::optional<glm::vec4> at(const glm::vec2& metres) const {
        if (!image_) return std::nullopt;
        const glm::vec2 tiled = metres / glm::max(texture_.tile, glm::vec2(1e-4F));
        const float c = static_cast<float>(std::cos(texture_.turn.inRadians()));
        const float s = static_cast<float>(std::sin(texture_.turn.inRadians()));
        const glm::vec2 turned = glm::fract(glm::vec2(c * tiled.x + s * tiled.y, c * tiled.y - s * tiled.x));
        const glm::vec2 first = turned / glm::vec2(std::max(texture_.columns, 1), std::max(texture_.rows, 1));
        const glm::ivec2 pixel =
            glm::clamp(glm::ivec2(first * glm::vec2(image_->size())), glm::ivec2(0), image_->size() - 1);
        const Image::Pixel& value = image_->at(pixel.x, pixel.y);
        return glm::vec4(value[0], value[1], value[2], value[3]) / 255.0F;
    }

    /// What says where holes are: alpha, or red where there is no alpha.
    [[nodiscard]] std::optional<float> coverAt(const glm::vec2& metres) const {
        const std::optional<glm::vec4> value = at(metres);
        if (!value) return std::nullopt;
        return hasAlpha_ ? value->w : value->x;
    }
    void lookForAlpha() { hasAlpha_ = image_ && hasAlpha(*image_); }

private:
    bool hasAlpha_ = false;
    const SceneTexture& texture_;
    const Image* image_ = nullptr;
};

class Ball {
public:
    Ball(const Material& material, const SceneAssets* assets)
        : material_(material), color_(material.colorTexture, assets), bumps_{Sampler(material.normalMaps[0], assets),
                                                                             Sampler(material.normalMaps[1], assets)},
          holes_(material.holes, assets) {
        holes_.lookForAlpha();
    }

    /// Colour (sRGB) and coverage at a place of the unit disc, y up.
    [[nodiscard]] glm::vec4 at(const glm::vec2& place) const {
        const float squared = glm::dot(place, place);
        if (squared >= 1.0F) return glm::vec4(0.0F);
        const glm::vec3 outward(place.x, place.y, std::sqrt(1.0F - squared));
        // As if a sheet were bent over it: lengths along the surface stay what they are.
        const float reach = std::asin(std::sqrt(squared)) / std::max(std::sqrt(squared), 1e-4F);
        const glm::vec2 metres = kBallRadius * reach * glm::vec2(place.x, -place.y);
        if (const auto cover = holes_.coverAt(metres); cover && *cover < material_.holeThreshold)
            return glm::vec4(0.0F);
        const std::optional<glm::vec4> picture = color_.at(metres);
        glm::vec3 base = linear(material_.color);
        if (picture) base *= linear(glm::vec3(*picture));
        float alpha = 1.0F;
        if (material_.alpha != Material::Alpha::opaque) alpha = (picture ? picture->w : 1.0F) * material_.opacity;
        const glm::vec3 light = material_.unlit ? base : lit(base, normal(outward, metres));
        return {display(light + linear(material_.emission) * material_.emissionStrength),
                std::max(alpha, 1.0F - material_.refraction * 0.5F)};
    }

private:
    [[nodiscard]] glm::vec3 normal(const glm::vec3& outward, const glm::vec2& metres) const {
        glm::vec3 bent = outward;
        for (const Sampler& map : bumps_)
            if (const auto value = map.at(metres))
                bent +=
                    material_.normalStrength * (glm::vec3((2.0F * value->x - 1.0F), (2.0F * value->y - 1.0F), 0.0F));
        return glm::normalize(bent);
    }

    [[nodiscard]] glm::vec3 lit(const glm::vec3& base, const glm::vec3& normal) const {
        const glm::vec3 view(0.0F, 0.0F, 1.0F);
        const glm::vec3 half = glm::normalize(kLight + view);
        const float shine = 2.0F / std::max(0.002F, material_.roughness * material_.roughness * material_.roughness *
                                                        material_.roughness);
        const float spread = (shine + 2.0F) / 8.0F * std::pow(std::max(glm::dot(normal, half), 0.0F), shine);
        const float facing = std::max(glm::dot(normal, kLight), 0.0F);
        const float rim = 1.0F - std::max(normal.z, 0.0F);
        const float fresnel = rim * rim * rim * rim * rim;
        const glm::vec3 mirror = 2.0F * normal.z * normal - view;
        const glm::vec3 around = glm::mix(glm::vec3(0.10F, 0.06F, 0.035F), glm::vec3(0.75F, 0.85F, 1.0F),
                                          glm::smoothstep(-0.25F, 0.35F, mirror.y));
        const glm::vec3 metal = glm::mix(glm::vec3(0.04F), base, material_.metallic);
        const glm::vec3 diffuse = base * (1.0F - material_.metallic) * (0.95F * facing + 0.22F + 0.1F * normal.y);
        const float mirrored =
            std::max(material_.metallic * (1.0F - 0.6F * material_.roughness),
                     material_.reflection + (1.0F - material_.reflection) * fresnel * (1.0F - material_.roughness));
        return glm::mix(diffuse, around * glm::mix(glm::vec3(1.0F), base, material_.metallic), mirrored) +
               metal * std::min(spread, 8.0F) * facing;
    }

    const Material& material_;
    Sampler color_;
    std::array<Sampler, 2> bumps_;
    Sampler holes_;
};

} // namespace

QImage paintMaterial(const Material& material, const SceneAssets* assets, int side) {
    const Ball ball(material, assets);
    QImage picture(side, side, QImage::Format_ARGB32);
    for (int y = 0; y < side; ++y) {
        auto* line = reinterpret_cast<QRgb*>(picture.scanLine(y));
        for (int x = 0; x < side; ++x) {
            glm::vec3 color(0.0F);
            float covered = 0.0F;
            for (int sample = 0; sample < kSamples * kSamples; ++sample) {
                const glm::vec2 pixel(static_cast<float>(x) + (static_cast<float>(sample % kSamples) + 0.5F) / kSamples,
                                      static_cast<float>(y) +
                                          (static_cast<float>(sample / kSamples) + 0.5F) / kSamples);
                const glm::vec2 place = (2.0F * pixel / static_cast<float>(side) - 1.0F) * 1.04F;
                const glm::vec4 seen = ball.at({place.x, -place.y});
                color += glm::vec3(seen) * seen.w;
                covered += seen.w;
            }
            if (covered > 0.0F) color /= covered;
            const float alpha = covered / (kSamples * kSamples);
            const glm::ivec3 channels(255.0F * glm::min(color, glm::vec3(1.0F)) + 0.5F);
            line[x] =
                qRgba(channels.x, channels.y, channels.z, static_cast<int>(255.0F * std::min(alpha, 1.0F) + 0.5F));
        }
    }
    return picture;
}

} // namespace lumorph::studio
