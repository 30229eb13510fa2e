#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/render/gl/picture_textures.h"
#include "core/render/gl/program.h"
#include "core/scene/material.h"
#include "core/scene/scene_assets.h"

namespace lumorph {

/// How a picture lies on a surface at a moment: texture coordinates are mat2(turn) * place + shift.
struct PicturePlacement {
    glm::vec4 turn{1.0F, 0.0F, 0.0F, 1.0F}; ///< two columns
    glm::vec2 shift{0.0F};
    int cell = 0; ///< of a flip-book, along the rows from the top left
    bool operator==(const PicturePlacement&) const = default;
};
[[nodiscard]] PicturePlacement placementOf(const SceneTexture& texture, double seconds);

/// sRGB to linear light.

/// Texture units of the eye pass.
namespace eye_unit {
enum Unit : int { color, normalA, normalB, holes, table, shadowDepth, shadowTiles, fog, weights };
} // namespace eye_unit

/// Sets materials in the programs of the eye pass.
class EyeMaterials {
public:
    /// The pictures and the time of what comes next.
    void begin(std::shared_ptr<const SceneAssets> assets, double seconds);

    /// What of eye_feature a material needs, seen by the eye; `unseen`: without what depends on a viewer, and whole.
    [[nodiscard]] std::uint32_t features(const Material& material, bool unseen = false) const;
    void apply(Program& program, const Material& material, float opacity, std::uint32_t features);
    /// Only what a shadow needs.
    void applyDepth(Program& program, const Material& material, std::uint32_t features);
    /// The picture that cuts holes into its shadow, if any, and how it lies.
    [[nodiscard]] std::pair<const Image*, PicturePlacement> cutter(const Material& material,
                                                                   std::uint32_t features) const;
    /// The table, as mirrors and clear things show it.
    void applyTable(Program& program, const Material& table);

    /// Its colour on average, linear.
    [[nodiscard]] glm::vec3 meanColor(const Material& material);

    [[nodiscard]] std::size_t objectCount() const noexcept { return pictures_.objectCount(); }

private:
    [[nodiscard]] bool has(const SceneTexture& texture) const;
    PictureTextures::Picture bind(Program& program, int unit, const SceneTexture& texture, PictureTextures::Use use,
                                  const char* sampler, const char* turn, const char* shift);
    void bindNormalMap(Program& program, const Material& material, std::size_t layer);
    void bindHoles(Program& program, const Material& material);

    PictureTextures pictures_;
    std::shared_ptr<const SceneAssets> assets_;
    std::shared_ptr<const Image> white_;
    double seconds_ = 0.0;
};

} // namespace lumorph
