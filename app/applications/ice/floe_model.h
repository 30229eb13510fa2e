#pragma once

#include "app/applications/ice/floe_field.h"
#include "app/applications/ice/ice_cover.h"
#include "core/scene/scene_assets.h"

namespace lumorph::ice {

inline constexpr double kIceThickness = 0.0085; ///< metres
/// Pictures that floes show: the sheet from above, in home coordinates, and rims from top to foot.
inline constexpr const char *kSheetPicture = "ice sheet", *kRimPicture = "ice rim";

/// A floe as it is seen, its middle at the origin and its top at height 0: rims and corners are round, the top is
/// hollow where it has melted, and cracks that have not parted it yet are drawn. Materials are `iceMaterials`.
[[nodiscard]] SceneModel floeModel(const IceCover& ice, const Floe& floe, const FloeField& field);

/// Of tops, of rims and of cracks.
[[nodiscard]] const std::vector<Material>& iceMaterials();

/// Metres over the top of a whole floe, at a place in home coordinates.
[[nodiscard]] double topAt(const FloeField& field, const glm::dvec2& home) noexcept;

} // namespace lumorph::ice
