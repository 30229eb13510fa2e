#pragma once

#include "app/applications/ice/polygon.h"
#include "core/scene/scene_assets.h"

/// The place of the pond on the device. Heights are device metres.
namespace lumorph::ice {

inline constexpr double kWaterLevel = 0.0180;
inline constexpr double kIceTop = 0.0206; ///< of a floe at rest
inline constexpr double kGroundLevel = 0.0012;
inline constexpr glm::dvec2 kPondHalf{0.1045, 0.0745}; ///< of the rectangle of pond and banks

/// The bank's line: convex, rounder than the tablet.
[[nodiscard]] Polygon pondShore();

/// What does not move: ground with pebbles, walls of earth, snow on the banks, stones and reeds.
[[nodiscard]] SceneModel pondBed(const Polygon& shore);

} // namespace lumorph::ice
