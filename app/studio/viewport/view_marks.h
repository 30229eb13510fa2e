#pragma once

#include <array>

#include <QColor>
#include <QFocusEvent>
#include <QPainter>
#include <QPointF>
#include <QSize>
#include <QString>

#include "app/studio/look/palette.h"
#include "core/render/viewport/view_camera.h"

namespace lumorph::studio {

/// Of x, y and z: red, green and blue that are seen well in the theme.
[[nodiscard]] std::array<QColor, 3> axisColors(const Palette& palette);

/// "Perspective", "Orthographic front": the projection and, where it looks along an axis, from which side.
[[nodiscard]] QString projectionName(const ViewCamera& camera);

/// The directions of the axes and, beside them, the projection and the side of a square of the ground grid (left out
/// when empty): the lower left corner of a view.
void paintLegend(QPainter& painter, const QSize& view, const ViewCamera& camera, const QString& grid,
                 const Palette& palette);
/// A line of text on a rounded plate beside the pointer, kept inside the view.
void paintChip(QPainter& painter, const QSize& view, const QPointF& pointer, const QString& text,
               const Palette& palette);
/// A sentence along the upper edge of the view.
void paintNotice(QPainter& painter, const QSize& view, const QString& text, const Palette& palette);
/// Shows that keys go to the view.
void paintFocusRing(QPainter& painter, const QSize& view, const Palette& palette);
/// The focus came by a key: only then is the ring shown.
[[nodiscard]] bool cameByKey(const QFocusEvent& event);

} // namespace lumorph::studio
