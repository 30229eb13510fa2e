#pragma once

#include "app/applications/navigation/ground_picture.h"
#include "app/applications/navigation/map.h"
#include "app/applications/navigation/view_ground.h"
#include "core/scene/material.h"
#include "core/scene/scene_assets.h"

namespace lumorph::navigation {

inline constexpr const char* kGroundImage = "navigation ground"; ///< assets that are in memory alone
inline constexpr const char* kReliefImage = "navigation relief";
inline constexpr double kFloor = 0.004; ///< y of the foot of the block of land, device metres

/// Of rivers and lakes; its pictures are bundled.
[[nodiscard]] Material waterMaterial();

/// The land of a view as one model, device metres: the ground with its cut walls, water, houses and trees. The ground
/// is painted with a picture over `window`; waters stand `swell` metres higher than the map has them.
[[nodiscard]] SceneModel landModel(const Map& map, const ViewGround& ground, const PictureWindow& window,
                                   double swell = 0.0);

} // namespace lumorph::navigation
