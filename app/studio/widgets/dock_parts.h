#pragma once

#include <cstddef>

#include <QAction>
#include <QLabel>
#include <QPushButton>
#include <QString>
#include <QToolButton>

namespace lumorph::studio {

/// A button with the text of a command, and its icon, that follows the command. A command that is not there gives a
/// button that is disabled. A primary one is filled with the accent colour: the next sensible step.
[[nodiscard]] QPushButton* makeCommandButton(QAction* command, const QString& name, QWidget* parent,
                                             bool primary = false);

/// A button with the icon of a command alone, for tool bars; its text is in the tool tip.
[[nodiscard]] QToolButton* makeCommandIcon(QAction* command, const QString& name, QWidget* parent);

/// A label whose digits all have the same width, wide enough for `widest`, so that nothing around it moves.
[[nodiscard]] QLabel* makeNumber(const QString& name, const QString& widest, QWidget* parent);

/// Sets a label in large digits of `pixels` height, wide enough for `widest`.
void makeLarge(QLabel* label, int pixels, const QString& widest);

/// "98 cm³" of cubic metres, "18.2 × 4.1 × 12.0 cm" of metres, "12 %" of a share.
[[nodiscard]] QString volumeText(double cubicMetres);
[[nodiscard]] QString sizeText(double x, double y, double z);
[[nodiscard]] QString shareText(double share);

} // namespace lumorph::studio
