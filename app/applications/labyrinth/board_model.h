#pragma once

#include <vector>

#include "app/applications/labyrinth/level_blocks.h"
#include "core/scene/material.h"
#include "core/scene/scene_assets.h"

namespace lumorph::labyrinth {

/// Materials of the pieces of a level, in the order of Block::Kind, of the depth below its holes, and of the floors of
/// the middle and of the highest terraces.
[[nodiscard]] std::vector<Material> boardMaterials(const Level& level);

/// The pieces of a level as a model with these materials, height 0 at the sheet; textures are mapped in metres.
[[nodiscard]] SceneModel boardModel(const Level& level, const std::vector<Block>& blocks);

} // namespace lumorph::labyrinth
