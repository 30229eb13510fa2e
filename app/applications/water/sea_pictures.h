#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "core/base/image.h"
#include "core/scene/scene_assets.h"

/// Materials of the sea and the pictures on them, which are in memory alone.
namespace lumorph::sea {

inline constexpr glm::dvec2 kBedHalf{0.165, 0.135}; ///< of the bed's picture: rays leave the water beyond its rim
inline constexpr double kSideDeep = 0.06;           ///< metres below the surface that the sides' picture covers

/// Indices of `seaMaterials`.
enum SeaMaterial : int { kSeaTop, kSeaSide, kSeaFoam };
[[nodiscard]] const std::vector<Material>& seaMaterials();
/// Yellow light on the water; its picture's second coordinate runs across it.
[[nodiscard]] Material glowMaterial();

/// Adds the pictures. `assets` holds that of caustics (material "Caustics").
void addSeaPictures(SceneAssets& assets);

/// A model of these parts on one node.
[[nodiscard]] SceneModel seaModel(std::vector<Model::Primitive> parts);

/// -1 to 1, smooth over a distance of 1.
[[nodiscard]] double softNoise(const glm::dvec2& at, std::uint32_t seed) noexcept;

} // namespace lumorph::sea
