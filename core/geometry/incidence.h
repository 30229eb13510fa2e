#pragma once

#include <span>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "core/base/units.h"
#include "core/geometry/calibrated_camera.h"

namespace lumorph {

/// Of the part of a surface that a projector lights (in its image, not shadowed by the surface itself), the share that
/// it meets at more than `limit` from head on, where its light is thin and its pixels are long (R42). By area; 0 when
/// it lights nothing. Found on a grid of 256 samples along the surface's longer side in the image.
[[nodiscard]] double shareBeyondIncidence(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                                          const glm::mat4& worldFromMesh, const CalibratedCamera& projector,
                                          Angle limit);

} // namespace lumorph
