#pragma once

#include <QColor>
#include <QPainter>
#include <QRectF>

namespace lumorph::studio {

/// What needs no words: the ways to play.
enum class Pictogram { mouse, keys, tilt, pad, hand };

/// Draws one in the middle of a box, in one colour. `turn` in [0, 1) is how far its motion has come; it begins again
/// without a jump.
void paintPictogram(QPainter& painter, Pictogram what, const QRectF& box, const QColor& ink, double turn = 0.0);

/// A key with what stands on it.
void paintKeycap(QPainter& painter, const QRectF& box, const QString& text, const QColor& ink);

} // namespace lumorph::studio
