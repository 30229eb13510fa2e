#pragma once

#include <optional>

#include <QString>

namespace lumorph::studio {

/// What a number measures: how it is shown, which units it accepts, and what one unit is in SI.
enum class Quantity { plain, length, angle, share, level, seconds, volume };

/// "2 cm", "45 deg", "0.5 rad", "12.5 %", "3 in" as a number in SI; without a unit the quantity's own (cm, degrees, %).
/// Both "." and "," separate decimals. Empty when it is no such number, or not finite.
[[nodiscard]] std::optional<double> parseQuantity(const QString& text, Quantity quantity);
/// With its unit, in as many digits as make sense: "2.40 cm", "45.0 deg" (as a degree sign), "120 %".
[[nodiscard]] QString formatQuantity(double value, Quantity quantity);
/// Units that it accepts, for telling the user: "mm, cm, m, in, ft". Empty for a number without unit.
[[nodiscard]] QString unitsOf(Quantity quantity);
/// What one arrow key press changes when nothing else is said, SI.
[[nodiscard]] double usualStep(Quantity quantity);

} // namespace lumorph::studio
