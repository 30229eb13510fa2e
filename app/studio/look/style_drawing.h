#pragma once

#include <QPainter>
#include <QStyle>
#include <QStyleOption>

namespace lumorph::studio {

// The drawings of StudioStyle, in the colours of the theme in use.

/// A check box, or with `round` a radio button: empty, checked, partly checked.
void drawMark(QPainter& painter, const QStyleOption& option, bool round);
void drawChevron(QPainter& painter, const QStyleOption& option, double degrees);
void drawChevronIn(QPainter& painter, const QStyleOption& option, const QRect& box, double degrees);
/// A hairline between docks; the accent while it is dragged or under the pointer.
void drawSeparator(QPainter& painter, const QStyleOption& option);
void drawSlider(QPainter& painter, const QStyleOptionSlider& option, const QRect& groove, const QRect& handle);
void drawScrollBar(QPainter& painter, const QStyleOptionSlider& option, const QRect& slider);
/// The box of a combo or spin box.
void drawField(QPainter& painter, const QStyleOption& option, bool framed);

/// Slim scroll bars have a slider and no arrows.
[[nodiscard]] QRect scrollBarPart(const QStyleOptionSlider& option, QStyle::SubControl part);

} // namespace lumorph::studio
