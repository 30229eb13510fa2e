#pragma once

#include <functional>
#include <optional>

#include <QLineEdit>
#include <QString>

namespace lumorph::studio {

/// What a number measures: how it is shown, which units it accepts, and what one unit is in SI.
enum class Quantity { plain, length, angle, share, level, seconds, volume };

/// "2 cm", "45 deg", "0.5 rad", "12.5 %", "3 in" as a number in SI; without a unit the quantity's own (cm, degrees, %).
/// Both "." and "," separate decimals. Empty when it is no such number, or not finite.
[[nodiscard]] std::optional<double> parseQuantity(const QString& text, Quantity quantity);
/// With its unit, in as many digits as make sense: "2.40 cm", "45.0 deg" (as a degree sign), "120 %".
[[nodiscard]] QString formatQuantity(double value, Quantity quantity);

/// A number with its unit: type it, scrub it by dragging sideways (Shift fine, Ctrl coarse), step it by the arrow keys
/// or the wheel, reset it by double click. Wrong input is marked and taken back on leaving.
class ValueField : public QLineEdit {
    Q_OBJECT
public:
    ValueField(Quantity quantity, double minimum, double maximum, double resetTo, QWidget* parent = nullptr);

    [[nodiscard]] double value() const noexcept { return value_; }
    /// Shows it without a signal.
    void setValue(double value);
    void setRange(double minimum, double maximum);
    /// What one arrow key press changes, SI.
    void setStep(double step);

signals:
    void previewed(double value); ///< while scrubbing
    void committed(double value); ///< entered, stepped, or the scrub ended
    void reverted();              ///< Esc during a scrub

protected:
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void focusOutEvent(QFocusEvent* event) override;
    void focusInEvent(QFocusEvent* event) override;

private:
    void show(double value);
    void enter();

    Quantity quantity_;
    double minimum_, maximum_, resetTo_, step_;
    double value_ = 0.0;
    bool scrubbing_ = false;
    double scrubStart_ = 0.0;
    int pressX_ = 0;
    bool pressed_ = false;
};

} // namespace lumorph::studio
