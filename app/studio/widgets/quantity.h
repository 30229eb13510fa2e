#pragma once

#include <optional>

#include <QString>

namespace lumorph::studio {

/// What a number measures: how it is shown, which units it accepts, and what one unit is in SI.
enum class Quantity { plain, length, angle, share, level, seconds, volume };

/// What was typed, as a number in SI, or in a sentence why it is none.
struct TypedQuantity {
    std::optional<double> value; ///< finite
    QString why;                 ///< empty where there is a value
};

/// "2 cm", "45 deg", "0.5 rad", "12.5 %", "3 in", and sums of such: "90+45", "2cm + 5mm", "(1 in + 2 mm) / 3". A number
/// without a unit has the quantity's own (cm, degrees, %), or is a factor. Both "." and "," separate decimals.
[[nodiscard]] TypedQuantity readQuantity(const QString& text, Quantity quantity);
/// Its value alone.
[[nodiscard]] std::optional<double> parseQuantity(const QString& text, Quantity quantity);
/// With its unit, in as many digits as make sense: "2.40 cm", "45.0 deg" (as a degree sign), "120 %".
[[nodiscard]] QString formatQuantity(double value, Quantity quantity);
/// Units that it accepts, for telling the user: "mm, cm, m, in, ft". Empty for a number without unit.
[[nodiscard]] QString unitsOf(Quantity quantity);
/// What one arrow key press changes when nothing else is said, SI.
[[nodiscard]] double usualStep(Quantity quantity);

} // namespace lumorph::studio
