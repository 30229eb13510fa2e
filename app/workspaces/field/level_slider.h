#pragma once

#include <QAbstractSlider>

namespace lumorph::studio {

/// A slider over the levels of one actuator that shows two places at once: the handle where the actuator is asked to
/// be, and a thin mark where it is by now under its velocity limit. A click jumps there; arrow and page keys step; Esc
/// takes a drag back.
class LevelSlider : public QAbstractSlider {
    Q_OBJECT
public:
    explicit LevelSlider(QWidget* parent = nullptr);

    /// At least 2; `value` is a level from 0 to levels - 1.
    void setLevels(int levels);
    /// Strokes in [0, 1]; no signal. While the user drags, the handle stays under the pointer.
    void show(double wanted, double estimated);
    using QWidget::show;
    /// Driven by the match: drawn in the accent colour.
    void setLive(bool live);
    [[nodiscard]] double wanted() const noexcept { return wanted_; }
    [[nodiscard]] double estimated() const noexcept { return estimated_; }
    /// Where a stroke is drawn, widget pixels; for tests.
    [[nodiscard]] double xOf(double stroke) const;

    [[nodiscard]] QSize sizeHint() const override;
    [[nodiscard]] QSize minimumSizeHint() const override;

signals:
    void previewed(int level); ///< while dragged
    void committed(int level); ///< dropped, or stepped by keys or wheel
    void reverted();           ///< Esc during a drag

protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;

private:
    void dragTo(double x);

    double wanted_ = 0.0;
    double estimated_ = 0.0;
    bool live_ = false;
    bool dragging_ = false;
};

} // namespace lumorph::studio
