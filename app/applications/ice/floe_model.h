#pragma once

#include "app/applications/ice/ice_cover.h"
#include "core/scene/scene_assets.h"

namespace lumorph::ice {

inline constexpr double kIceThickness = 0.0085; ///< metres

/// A floe as it is seen, its middle at the origin and its top at height 0: cells that are still one piece show no seam,
/// and free rims are bevelled. Materials are `iceMaterials`.
[[nodiscard]] SceneModel floeModel(const IceCover& ice, const Floe& floe);

/// Of tops, and of rims.
[[nodiscard]] const std::vector<Material>& iceMaterials();

} // namespace lumorph::ice
