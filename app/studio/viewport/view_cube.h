#pragma once

#include <optional>

#include <QPainter>
#include <QPointF>
#include <QRectF>
#include <QSize>
#include <glm/vec3.hpp>

#include "app/studio/look/palette.h"
#include "core/render/viewport/view_camera.h"

namespace lumorph::studio {

/// A small cube in the corner of a view that turns with it. Its faces, edges and corners are places to look from, named
/// by a direction with components -1, 0 and 1: (0, 1, 0) is from above, (1, 0, 1) from between right and front.
using CubeSide = glm::ivec3;

/// Where it is in a view of this size.
[[nodiscard]] QRectF viewCubeBox(const QSize& view);
/// What of the cube is under the pointer.
[[nodiscard]] std::optional<CubeSide> viewCubeAt(const QRectF& box, const ViewCamera& camera, const QPointF& pointer);
void paintViewCube(QPainter& painter, const QRectF& box, const ViewCamera& camera, std::optional<CubeSide> hot,
                   const Palette& palette);

} // namespace lumorph::studio
