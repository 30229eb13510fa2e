#pragma once

#include "core/geometry/triangle_mesh.h"
#include "core/scene/posed_scene.h"

namespace lumorph {

/// Takes into `onTable` the shadow that a box in the world throws on the table, edges included; false: it has no end.
[[nodiscard]] bool includeShadow(Box& onTable, const Box& caster, const PosedLight& light);

} // namespace lumorph
