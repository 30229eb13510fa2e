#pragma once

#include <memory>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "app/applications/navigation/map.h"
#include "core/base/image.h"

/// The colours of things: one picture with a cell for each paint, in its shades, and one for walls with windows.
namespace lumorph::navigation {

inline constexpr const char* kPaletteImage = "navigation palette"; ///< an asset that is in memory alone

[[nodiscard]] std::shared_ptr<const Image> paletteImage();
[[nodiscard]] glm::vec3 colorOf(Paint paint) noexcept; ///< sRGB
/// Where a paint is on the picture, v downwards.
[[nodiscard]] glm::vec2 paintPlace(Paint paint) noexcept;
[[nodiscard]] glm::vec2 paintPlace(Paint paint, int shade) noexcept;
/// The same of a wall with windows: bays and storeys are counted from its foot.
[[nodiscard]] glm::vec2 facadePlace(Paint paint, float bays, float storeys) noexcept;

} // namespace lumorph::navigation
