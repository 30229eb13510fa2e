#pragma once

#include <QAction>
#include <QLabel>
#include <QString>
#include <QToolButton>

namespace lumorph::studio {

/// A button for a command: its icon, and its text too where `withText`. A command that is not there gives a button that
/// is disabled.
[[nodiscard]] QToolButton* makeActionButton(QAction* action, bool withText, QWidget* parent);

/// A label whose digits all have the same width, wide enough for `widest`, so that nothing around it moves.
[[nodiscard]] QLabel* makeNumber(const QString& name, const QString& widest, QWidget* parent);

/// "98 cm³" of cubic metres, "18.2 x 4.1 x 12.0 cm" of metres, "12 %" of a share, "69,998" of a count.
[[nodiscard]] QString volumeText(double cubicMetres);
[[nodiscard]] QString sizeText(double x, double y, double z);
[[nodiscard]] QString shareText(double share);
[[nodiscard]] QString countText(std::size_t count);

} // namespace lumorph::studio
