#pragma once

#include <vector>

#include <QColor>
#include <QString>
#include <QWidget>

namespace lumorph::studio {

/// Curves over a common axis, as small as a hand: axes with units, a legend, the values under the pointer, a mark. By
/// keyboard the arrow keys, Home and End read the values step by step, and Enter chooses one.
class Plot : public QWidget {
    Q_OBJECT
public:
    struct Curve {
        QString name;
        QColor color;
        std::vector<double> values; ///< one a step of x; NaN leaves a gap
        bool dashed = false;
    };

    explicit Plot(QWidget* parent = nullptr);

    void setAxes(const QString& x, const QString& y);
    void setCurves(std::vector<Curve> curves);
    /// Vertical line at a step of x, such as the chosen level; negative: none.
    void setMark(double x);
    /// Range of y; from the values when equal.
    void setRange(double low, double high);
    /// What stands here while there are no curves.
    void setEmptyText(const QString& text);

    [[nodiscard]] QSize sizeHint() const override;
    [[nodiscard]] QSize minimumSizeHint() const override;
    [[nodiscard]] const std::vector<Curve>& curves() const noexcept { return curves_; }
    /// Where a value is drawn, widget pixels; for tests.
    [[nodiscard]] QPointF pointOf(double x, double y) const;

signals:
    void clicked(int x); ///< the step under the pointer, or read by the keys

protected:
    void paintEvent(QPaintEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void focusOutEvent(QFocusEvent* event) override;
    void leaveEvent(QEvent* event) override;

private:
    /// Shows the values at a step; negative: none.
    void read(int step);

    std::vector<Curve> curves_;
    QString x_, y_, empty_;
    double mark_ = -1.0, low_ = 0.0, high_ = 0.0;
    int hover_ = -1;
};

} // namespace lumorph::studio
