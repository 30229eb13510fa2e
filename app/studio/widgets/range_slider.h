#pragma once

#include <QWidget>

namespace lumorph::studio {

/// A slider with two handles for a range of whole numbers, both ends included. Drag a handle or the bar between them;
/// by keyboard the arrow keys move the handle in use, with Shift both, Home and End to its limits, Space takes the
/// other handle.
class RangeSlider : public QWidget {
    Q_OBJECT
public:
    explicit RangeSlider(QWidget* parent = nullptr);

    void setLimits(int lowest, int highest);
    /// Shows it without a signal; kept inside the limits, and from <= to.
    void setRange(int from, int to);
    [[nodiscard]] int from() const noexcept { return from_; }
    [[nodiscard]] int to() const noexcept { return to_; }
    /// Where the middle of a handle is, widget pixels; for tests.
    [[nodiscard]] QPoint handleAt(int value) const;

    [[nodiscard]] QSize sizeHint() const override;
    [[nodiscard]] QSize minimumSizeHint() const override;

signals:
    void changed(int from, int to);

protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void enterEvent(QEnterEvent* event) override;
    void leaveEvent(QEvent* event) override;

private:
    enum class Part { none, from, to, both };
    [[nodiscard]] double valueAt(double x) const;
    void move(Part part, int from, int to);
    void drawHandle(QPainter& painter, Part part, int value) const;

    int lowest_ = 0, highest_ = 1;
    int from_ = 0, to_ = 1;
    Part used_ = Part::from;
    Part dragged_ = Part::none;
    double pressedAt_ = 0.0;
    int pressedFrom_ = 0, pressedTo_ = 0;
};

} // namespace lumorph::studio
