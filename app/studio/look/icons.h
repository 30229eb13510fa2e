#pragma once

#include <QByteArray>
#include <QIcon>
#include <QString>

namespace lumorph::studio {

/// What an icon stands on, which decides its colour.
enum class IconRole { control, muted, accent, onAccent, onDanger, warning, danger };

/// An icon of the set in resources/icons by its name, in the colours of the theme in use (normal, disabled, checked),
/// sharp at any desktop scale; it follows a change of the theme. One that is missing is drawn as an empty square and
/// told once on stderr, since a window without a picture is better than no window. `degrees` turns it clockwise.
[[nodiscard]] QIcon icon(const QString& name, IconRole role = IconRole::control, double degrees = 0.0);

/// The drawing of an icon as the file has it. Throws DataError when there is no such icon.
[[nodiscard]] QByteArray iconSource(const QString& name);

/// Paints an icon in one colour, turned clockwise.
void paintIcon(QPainter& painter, const QRectF& box, const QString& name, const QColor& color, double degrees = 0.0);

} // namespace lumorph::studio
