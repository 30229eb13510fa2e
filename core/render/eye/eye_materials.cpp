#include "core/render/eye/eye_materials.h"

#include <array>
#include <cmath>
#include <set>

#include "core/base/srgb.h"
#include "core/render/eye/eye_programs.h"

namespace lumorph {
namespace {

// Rougher surfaces show no highlight worth its cost.
constexpr float kDullRoughness = 0.9F;
// Levels of the mipmap by which a fully rough surface blurs what it mirrors.
constexpr float kRoughBlur = 5.0F;

double tileOf(float tile) { return std::isfinite(tile) && std::abs(tile) > 1e-6F ? tile : 1.0; }

} // namespace

PicturePlacement placementOf(const SceneTexture& texture, double seconds) {
    const double c = std::cos(texture.turn.inRadians());
    const double s = std::sin(texture.turn.inRadians());
    const double x = tileOf(texture.tile.x);
    const double y = tileOf(texture.tile.y);
    // On a page whose y runs down, a turn to the left looks so.
    const glm::dmat2 turn(glm::dvec2(c / x, s / y), glm::dvec2(-s / x, c / y));
    const glm::dvec2 gone = turn * (glm::dvec2(texture.velocity) * seconds);
    PicturePlacement placement;
    placement.turn = glm::vec4(turn[0], turn[1]);
    placement.shift = glm::vec2(std::ceil(gone.x) - gone.x, std::ceil(gone.y) - gone.y);
    const int cells = std::max(texture.columns, 1) * std::max(texture.rows, 1);
    const double shown = std::floor(seconds * texture.framesPerSecond);
    if (cells > 1 && std::isfinite(shown)) placement.cell = static_cast<int>(shown - cells * std::floor(shown / cells));
    return placement;
}

void EyeMaterials::begin(std::shared_ptr<const SceneAssets> assets, double seconds) {
    if (!white_) white_ = std::make_shared<Image>(glm::ivec2(1), Image::Pixel{255, 255, 255, 255});
    if (assets != assets_) {
        // A picture that was read anew is another object: the old one is not asked for again.
        std::set<const Image*> held{white_.get()};
        if (assets)
            for (const auto& [name, image] : assets->images) held.insert(image.get());
        pictures_.keepOnly(held);
        assets_ = std::move(assets);
    }
    seconds_ = seconds;
    pictures_.sweep();
}

bool EyeMaterials::has(const SceneTexture& texture) const {
    if (texture.image.empty() || !assets_) return false;
    const auto found = assets_->images.find(texture.image);
    return found != assets_->images.end() && found->second && found->second->size().x > 0;
}

std::uint32_t EyeMaterials::features(const Material& material, bool unseen) const {
    using namespace eye_feature;
    std::uint32_t bits = 0;
    if (has(material.colorTexture)) bits |= colorTexture;
    if (material.alpha == Material::Alpha::cutout && has(material.colorTexture)) bits |= cutout;
    if (material.unlit) return bits | unlit | (!unseen && has(material.holes) ? holes | holeMask : 0U);
    if (material.normalStrength != 0.0F) {
        if (has(material.normalMaps[0])) bits |= normalA;
        if (has(material.normalMaps[1])) bits |= normalB;
    }
    if (unseen) return bits;
    if (has(material.holes)) bits |= holes | holeMask;
    if (material.roughness < kDullRoughness || material.metallic > 0.0F) bits |= specular;
    if (material.reflection > 0.0F) bits |= reflection;
    if (material.refraction > 0.0F) bits |= refraction;
    return bits;
}

PictureTextures::Picture EyeMaterials::bind(Program& program, int unit, const SceneTexture& texture,
                                            PictureTextures::Use use, const char* sampler, const char* turn,
                                            const char* shift) {
    const PicturePlacement placement = placementOf(texture, seconds_);
    const bool there = has(texture);
    // A picture that is new is uploaded into the unit it is for: no other unit may lose its own.
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    const auto picture =
        pictures_.picture(there ? assets_->images.at(texture.image) : white_, use,
                          there ? glm::ivec2(texture.columns, texture.rows) : glm::ivec2(1), placement.cell);
    glBindTexture(GL_TEXTURE_2D, picture.texture);
    program.set(sampler, unit);
    program.set(turn, placement.turn);
    program.set(shift, placement.shift);
    return picture;
}

void EyeMaterials::bindNormalMap(Program& program, const Material& material, std::size_t layer) {
    constexpr std::array kSampler{"normalPictureA", "normalPictureB"};
    constexpr std::array kTurn{"normalTurnA", "normalTurnB"};
    constexpr std::array kShift{"normalShiftA", "normalShiftB"};
    constexpr std::array kBend{"normalBendA", "normalBendB"};
    const SceneTexture& texture = material.normalMaps[layer];
    bind(program, eye_unit::normalA + static_cast<int>(layer), texture, PictureTextures::Use::data, kSampler[layer],
         kTurn[layer], kShift[layer]);
    const auto c = static_cast<float>(std::cos(texture.turn.inRadians()));
    const auto s = static_cast<float>(std::sin(texture.turn.inRadians()));
    program.set(kBend[layer], material.normalStrength * glm::vec4(c, s, -s, c));
}

void EyeMaterials::bindHoles(Program& program, const Material& material) {
    const auto picture =
        bind(program, eye_unit::holes, material.holes, PictureTextures::Use::data, "holeMask", "holeTurn", "holeShift");
    program.set("holeChannel", picture.hasAlpha ? glm::vec4(0, 0, 0, 1) : glm::vec4(1, 0, 0, 0));
    program.set("holeThreshold", material.holeThreshold);
}

void EyeMaterials::apply(Program& program, const Material& material, float opacity, std::uint32_t features) {
    using namespace eye_feature;
    const float own = material.alpha == Material::Alpha::blend ? material.opacity : 1.0F;
    program.set("baseColor", glm::vec4(linearFromSrgb(material.color), own * opacity));
    program.set("emitted", material.emissionStrength * linearFromSrgb(material.emission));
    if ((features & colorTexture) != 0)
        bind(program, eye_unit::color, material.colorTexture, PictureTextures::Use::color, "colorPicture", "colorTurn",
             "colorShift");
    if ((features & normalA) != 0) bindNormalMap(program, material, 0);
    if ((features & normalB) != 0) bindNormalMap(program, material, 1);
    if ((features & holeMask) != 0) bindHoles(program, material);
    if ((features & specular) != 0) {
        const float alpha = std::max(material.roughness * material.roughness, 0.02F);
        program.set("gloss", glm::vec2(alpha * alpha, material.roughness + 0.5F));
        program.set("metal", material.metallic);
    }
    // Moving pictures on something clear are light on the ground beneath it.
    if ((features & refraction) != 0 && (features & colorTexture) != 0)
        program.set("onFloor", material.colorTexture.columns * material.colorTexture.rows > 1 ? 1.0F : 0.0F);
    if ((features & (reflection | refraction)) != 0)
        program.set("optics",
                    glm::vec4(material.reflection, material.refraction, 1.0F / std::max(material.refractiveIndex, 1.0F),
                              kRoughBlur * material.roughness));
}

void EyeMaterials::applyDepth(Program& program, const Material& material, std::uint32_t features) {
    if ((features & eye_feature::cutout) != 0)
        bind(program, eye_unit::color, material.colorTexture, PictureTextures::Use::color, "colorPicture", "colorTurn",
             "colorShift");
    if ((features & eye_feature::holeMask) != 0) bindHoles(program, material);
}

std::pair<const Image*, PicturePlacement> EyeMaterials::cutter(const Material& material, std::uint32_t features) const {
    if ((features & (eye_feature::holeMask | eye_feature::cutout)) == 0) return {};
    const bool mask = (features & eye_feature::holeMask) != 0;
    const SceneTexture& texture = mask ? material.holes : material.colorTexture;
    return {assets_->images.at(texture.image).get(), placementOf(texture, seconds_)};
}

void EyeMaterials::applyTable(Program& program, const Material& table) {
    bind(program, eye_unit::table, table.colorTexture, PictureTextures::Use::color, "tablePicture", "tableTurn",
         "tableShift");
    program.set("tableColor", linearFromSrgb(table.color));
}

glm::vec3 EyeMaterials::meanColor(const Material& material) {
    const glm::vec3 color = linearFromSrgb(material.color);
    if (!has(material.colorTexture)) return color;
    return color * pictures_.picture(assets_->images.at(material.colorTexture.image), PictureTextures::Use::color).mean;
}

} // namespace lumorph
