#pragma once

#include <QDockWidget>

namespace lumorph::studio {

/// A slim title bar of a dock: icon, title, float and close. It is dragged like Qt's own, since it leaves the mouse to
/// the dock.
[[nodiscard]] QWidget* makeDockTitle(QDockWidget& dock, const QString& icon);

} // namespace lumorph::studio
