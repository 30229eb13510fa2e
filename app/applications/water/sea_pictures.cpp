#include "app/applications/water/sea_pictures.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "app/applications/water/water.h"
#include "core/scene/material_library.h"

namespace lumorph::sea {
namespace {

constexpr const char* kBedPicture = "sea bed";
constexpr const char* kSidePicture = "sea side";
constexpr const char* kFoamPicture = "sea foam";
constexpr const char* kGlowPicture = "sea glow";
constexpr int kFrames = 4;                            ///< a side of the flip-book
constexpr glm::ivec2 kBedPixels{240, 196};            ///< of each of its pictures
constexpr double kCausticTile = 0.075;                ///< metres of one repeat
constexpr float kDarkest = 0.10F, kBrightest = 0.95F; ///< red of the picture of caustics

double hashedCell(std::int64_t x, std::int64_t y, std::uint32_t seed) {
    auto h =
        static_cast<std::uint32_t>(x) * 0x8da6b343U ^ static_cast<std::uint32_t>(y) * 0xd8163841U ^ seed * 0xcb1ab31fU;
    h = (h ^ (h >> 15U)) * 0x2c1b3c6dU;
    h = (h ^ (h >> 12U)) * 0x297a2d39U;
    return static_cast<double>(h ^ (h >> 15U)) * 0x1p-31 - 1.0;
}

std::uint8_t byteOf(double value) {
    return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
}
Image::Pixel pixelOf(const glm::dvec3& color, double alpha = 1.0) {
    return {byteOf(color.r), byteOf(color.g), byteOf(color.b), byteOf(alpha)};
}

double soft(double from, double to, double value) {
    const double share = std::clamp((value - from) / (to - from), 0.0, 1.0);
    return share * share * (3.0 - 2.0 * share);
}

/// The sea's ground from above, without light on it: a sandbank on two sides, deep water between, stones.
glm::dvec3 groundAt(const glm::dvec2& at) {
    const double bank = soft(0.01, 0.085, -0.55 * at.x + 0.75 * at.y + 0.018 * softNoise(at / 0.035, 11));
    const double reef = soft(0.062, 0.01, glm::length((at - glm::dvec2(0.062, -0.045)) / glm::dvec2(1.2, 0.9)));
    const double shallow = std::max(bank, 0.75 * reef);
    const double ribs = std::sin(at.x * 520.0 + at.y * 300.0 + 4.0 * softNoise(at / 0.018, 12));
    const double grain = 0.05 * ribs + 0.05 * softNoise(at / 0.0035, 13);
    glm::dvec3 sand = glm::mix(glm::dvec3(0.08, 0.36, 0.52), glm::dvec3(0.97, 0.93, 0.74), shallow) * (1.0 + grain);
    const double stone = soft(0.38, 0.52, softNoise(at / 0.014, 14) + 0.35 * softNoise(at / 0.006, 15));
    return glm::mix(sand, sand * glm::dvec3(0.34, 0.40, 0.36), 0.8 * stone);
}

/// Its red as a share of its range, bilinear within one picture of the flip-book.
double causticAt(const Image& sheet, int frame, const glm::dvec2& at) {
    const int side = sheet.size().x / kFrames;
    const glm::dvec2 place = (at - glm::floor(at)) * static_cast<double>(side);
    const glm::ivec2 low(place), corner = side * glm::ivec2(frame % kFrames, frame / kFrames);
    const glm::dvec2 f = place - glm::dvec2(low);
    const auto red = [&](int x, int y) { return sheet.at(corner.x + x % side, corner.y + y % side)[0] / 255.0; };
    const double value = std::lerp(std::lerp(red(low.x, low.y), red(low.x + 1, low.y), f.x),
                                   std::lerp(red(low.x, low.y + 1), red(low.x + 1, low.y + 1), f.x), f.y);
    return std::clamp((value - double{kDarkest}) / double{kBrightest - kDarkest}, 0.0, 1.0);
}

/// The ground with the net of light that waves throw on it, for each moment of a loop.
Image bedSheet(const Image& caustics) {
    Image sheet(kFrames * kBedPixels);
    for (int y = 0; y < kBedPixels.y; ++y)
        for (int x = 0; x < kBedPixels.x; ++x) {
            const glm::dvec2 share = (glm::dvec2(x, y) + 0.5) / glm::dvec2(kBedPixels);
            const glm::dvec2 at = (2.0 * share - 1.0) * kBedHalf;
            const glm::dvec3 ground = groundAt(at);
            for (int frame = 0; frame < kFrames * kFrames; ++frame) {
                const double net = causticAt(caustics, frame, at / kCausticTile);
                const glm::ivec2 corner = kBedPixels * glm::ivec2(frame % kFrames, frame / kFrames);
                sheet.at(corner.x + x, corner.y + y) = pixelOf(ground * (0.72 + 0.75 * net));
            }
        }
    return sheet;
}

/// Bright under the surface, dark in the depth, with shafts of light.
Image sidePicture() {
    Image picture(glm::ivec2(128, 64));
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 128; ++x) {
            const double deep = (y + 0.5) / 64.0;
            const double turn = 2.0 * 3.14159265358979 * x / 128.0;
            const double shafts = std::sin(3.0 * turn + 2.0 * deep) + 0.7 * std::sin(7.0 * turn - 1.5 * deep) +
                                  0.5 * std::sin(13.0 * turn + deep);
            const glm::dvec3 color =
                glm::mix(glm::dvec3(0.30, 0.78, 0.82), glm::dvec3(0.04, 0.30, 0.48), soft(-0.05, 0.75, deep));
            const double line = 0.35 * std::exp(-deep / 0.025);
            picture.at(x, y) = pixelOf(color * (1.0 + 0.10 * shafts * (1.0 - deep)) + line);
        }
    return picture;
}

/// Lace from left to right, and from none (top) to all white (bottom).
Image foamPicture() {
    Image picture(glm::ivec2(256, 64));
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 256; ++x) {
            const double much = (y + 0.5) / 64.0;
            const double turn = 2.0 * 3.14159265358979 * x / 256.0;
            const glm::dvec2 around(std::cos(turn), std::sin(turn)); // so that it repeats
            const double lace = 0.52 + 0.42 * softNoise(3.0 * around + glm::dvec2(0.0, 2.0 * much), 21) +
                                0.30 * softNoise(8.0 * around - glm::dvec2(4.0 * much, 0.0), 22);
            const double alpha =
                soft(1.0 - 1.15 * much - 0.22, 1.0 - 1.15 * much + 0.22, lace) * soft(0.02, 0.25, much);
            picture.at(x, y) = pixelOf(glm::dvec3(1.0), 0.82 * alpha);
        }
    return picture;
}

Image glowPicture() {
    Image picture(glm::ivec2(4, 32));
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 4; ++x) {
            const double across = 2.0 * (y + 0.5) / 32.0 - 1.0;
            const double core = std::exp(-18.0 * across * across), halo = 0.45 * std::pow(1.0 - std::abs(across), 1.5);
            picture.at(x, y) = pixelOf(glm::mix(glm::dvec3(1.0, 0.72, 0.20), glm::dvec3(1.0, 0.96, 0.75), core),
                                       std::min(1.0, core + halo));
        }
    return picture;
}

Material veil(const std::string& name, const char* picture) {
    Material material;
    material.name = name;
    material.color = glm::vec3(1.0F);
    material.colorTexture.image = picture;
    material.colorTexture.tile = glm::vec2(1.0F);
    material.alpha = Material::Alpha::blend;
    material.unlit = true;
    return material;
}

Material topMaterial() {
    Material top = seaMaterial();
    top.colorTexture.image = kBedPicture;
    top.colorTexture.tile = 2.0F * glm::vec2(kBedHalf);
    return top;
}

Material sideMaterial() {
    Material side;
    side.name = "Sea, cut";
    side.color = glm::vec3(1.0F);
    side.colorTexture.image = kSidePicture;
    side.colorTexture.tile = {0.21F, 1.0F};
    side.roughness = 0.2F;
    side.reflection = 0.35F;
    side.emission = {0.02F, 0.20F, 0.27F};
    side.emissionStrength = 0.8F;
    return side;
}

} // namespace

double softNoise(const glm::dvec2& at, std::uint32_t seed) noexcept {
    const glm::dvec2 low = glm::floor(at);
    const glm::dvec2 f = (at - low) * (at - low) * (3.0 - 2.0 * (at - low));
    const auto x = static_cast<std::int64_t>(low.x), y = static_cast<std::int64_t>(low.y);
    return std::lerp(std::lerp(hashedCell(x, y, seed), hashedCell(x + 1, y, seed), f.x),
                     std::lerp(hashedCell(x, y + 1, seed), hashedCell(x + 1, y + 1, seed), f.x), f.y);
}

const std::vector<Material>& seaMaterials() {
    static const std::vector<Material> materials = [] {
        Material foam = veil("Foam", kFoamPicture);
        foam.color = {0.93F, 0.97F, 0.98F};
        return std::vector{topMaterial(), sideMaterial(), foam};
    }();
    return materials;
}

Material glowMaterial() { return veil("Harbour light", kGlowPicture); }

void addSeaPictures(SceneAssets& assets) {
    const std::shared_ptr<const Image>& caustics = assets.images.at(seaMaterial().colorTexture.image);
    assets.images[kBedPicture] = std::make_shared<const Image>(bedSheet(*caustics));
    assets.images[kSidePicture] = std::make_shared<const Image>(sidePicture());
    assets.images[kFoamPicture] = std::make_shared<const Image>(foamPicture());
    assets.images[kGlowPicture] = std::make_shared<const Image>(glowPicture());
}

SceneModel seaModel(std::vector<Model::Primitive> parts) {
    SceneModel made;
    made.model.name = "Sea";
    Model::Mesh mesh;
    mesh.name = "Sea";
    mesh.primitives = std::move(parts);
    made.model.meshes.push_back(std::move(mesh));
    Model::Node node;
    node.name = "Sea";
    node.mesh = 0;
    made.model.nodes.push_back(std::move(node));
    made.model.roots = {0};
    return made;
}

} // namespace lumorph::sea
