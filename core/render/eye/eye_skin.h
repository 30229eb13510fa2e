#pragma once

#include <cstdint>

#include <glm/mat4x4.hpp>

#include "core/geometry/triangle_mesh.h"
#include "core/render/gl/program.h"
#include "core/scene/scene.h"

namespace lumorph {

/// Bits of eye_feature for the holes and the apparent size of the device's skin.
[[nodiscard]] std::uint32_t skinFeatures(const DeviceSkin& skin);

/// Sets them in the current program; `rest` is the box of the device at rest.
void applySkin(Program& program, const DeviceSkin& skin, const Box& rest, const glm::mat4& worldFromDevice);

/// For the table beneath: where the eye looks at it through holes.
void applyHolesAbove(Program& program, const DeviceSkin& skin, const Box& rest, const glm::mat4& worldFromDevice);

} // namespace lumorph
