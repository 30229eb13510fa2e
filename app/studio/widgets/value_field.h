#pragma once

#include <optional>

#include <QLineEdit>
#include <QString>

#include "app/studio/widgets/quantity.h"

namespace lumorph::studio {

/// A number with its unit: type it, scrub it by dragging sideways (Shift fine, Ctrl coarse), step it by the arrow keys
/// or, while it has the keyboard, the wheel; reset it by double click. It calculates: "90+45". Wrong input is marked,
/// and taken back on leaving; why, and what became of a number beyond the range, is said beside it.
class ValueField : public QLineEdit {
    Q_OBJECT
public:
    ValueField(Quantity quantity, double minimum, double maximum, double resetTo, QWidget* parent = nullptr);

    [[nodiscard]] double value() const noexcept { return value_; }
    /// Shows it without a signal. What the user is typing or dragging right now is left alone.
    void setValue(double value);
    void setRange(double minimum, double maximum);
    /// A typed number that is out of range is not taken for the nearest one: it is marked, `refused` says why, and the
    /// value stays. For numbers where another than the one that was meant does harm.
    void setRefusing(bool refusing);
    /// What one arrow key press changes, SI.
    void setStep(double step);

    [[nodiscard]] QSize sizeHint() const override;
    /// What it says beside itself; empty: nothing.
    [[nodiscard]] const QString& why() const noexcept { return why_; }

signals:
    void previewed(double value);     ///< while scrubbing
    void committed(double value);     ///< entered, stepped, or the scrub ended
    void reverted();                  ///< Esc during a scrub
    void refused(const QString& why); ///< "2600 is not from 1050 to 2500; it stays 2000"

protected:
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void focusOutEvent(QFocusEvent* event) override;
    void focusInEvent(QFocusEvent* event) override;
    bool event(QEvent* event) override;

private:
    void show(double value);
    void enter();
    void step(double steps, Qt::KeyboardModifiers modifiers);
    void commit(double value);
    void endScrub();
    void mark(bool wrong);
    void tell(const QString& why);

    Quantity quantity_;
    double minimum_, maximum_, resetTo_, step_;
    double value_ = 0.0;
    QString why_;
    bool refusing_ = false;
    bool pressed_ = false;   ///< the button is down on a field that was not being edited
    bool scrubbing_ = false; ///< and the pointer has moved
    int pressX_ = 0;
    int lastX_ = 0;
    double scrubStart_ = 0.0;
    double scrubbed_ = 0.0; ///< before it is held inside the range
};

} // namespace lumorph::studio
