#pragma once

#include <vector>

#include <QApplication>
#include <QColor>
#include <QString>

#include "core/render/viewport/theme.h"

namespace lumorph::studio {

/// The colours of a theme. One accent, for what is live and for the next sensible step only.
struct Palette {
    QColor window;  ///< behind everything
    QColor panel;   ///< docks
    QColor raised;  ///< buttons, fields
    QColor hovered; ///< the same under the pointer
    QColor sunken;  ///< plots, lists
    QColor line;    ///< hairlines between panels
    QColor border;  ///< of controls; >= 3:1 against `panel`
    QColor text;
    QColor textMuted;  ///< labels, units; >= 4.5:1 too
    QColor accent;     ///< fills
    QColor onAccent;   ///< text on it
    QColor accentText; ///< accent as text on panels
    QColor danger;
    QColor onDanger;
    QColor warning; ///< as text and icon on panels
    QColor success;
    QColor unmatched;  ///< target volume that the rig leaves out
    QColor overfilled; ///< rig volume outside the target
    QColor levelLow;   ///< field voxels: light green is a low level,
    QColor levelHigh;  ///< darker green a higher one
};

[[nodiscard]] const Palette& paletteOf(Theme theme);

/// `share` of the way from one colour to another, in [0, 1].
[[nodiscard]] QColor blend(const QColor& from, const QColor& to, double share);
/// What a selected item of a list or menu lies on.
[[nodiscard]] QColor selectedColor(const Palette& palette);
[[nodiscard]] QColor disabledText(const Palette& palette);
[[nodiscard]] QColor hoveredAccent(const Palette& palette);
[[nodiscard]] QColor hoveredDanger(const Palette& palette);

/// A text colour and what it is written on, by name; the contrast test walks this list.
struct TextPair {
    QString name;
    QColor text;
    QColor background;
};
[[nodiscard]] std::vector<TextPair> textPairs(const Palette& palette);
/// WCAG contrast ratio, 1 to 21.
[[nodiscard]] double contrast(const QColor& a, const QColor& b);

/// Fusion with our palette, the bundled typeface and our style sheet. May be called again to change the theme.
void applyTheme(QApplication& application, Theme theme);
/// The theme in use.
[[nodiscard]] Theme currentTheme();
[[nodiscard]] const Palette& currentPalette();

} // namespace lumorph::studio
