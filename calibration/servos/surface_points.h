#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "calibration/solve/observations.h"
#include "core/geometry/calibrated_camera.h"

namespace lumorph {

/// A place on whatever a camera and a projector both see.
struct MeasuredPoint {
    glm::dvec3 place{0.0}; ///< world metres
    double weight = 1.0;   ///< 1: as sure as most
};

/// Decoded light as places in the world, by a calibrated pair. Light whose ray from the projector passes the camera's
/// ray by more than `kMostApart` is left out: it came by way of another surface, or was read wrongly.
[[nodiscard]] std::vector<MeasuredPoint>
surfacePoints(std::span<const ProjectorPoint> light, const CalibratedCamera& camera, const CalibratedCamera& projector);

inline constexpr double kMostApart = 0.003; ///< metres

} // namespace lumorph
