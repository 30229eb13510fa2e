#pragma once

#include <QWidget>

namespace lumorph::studio {

/// A plate over the viewport: rounded, a little see-through, so that the scene stays the thing itself.
class FloatingCard : public QWidget {
    Q_OBJECT
public:
    using QWidget::QWidget;

protected:
    void paintEvent(QPaintEvent* event) override;
    /// Clicks on the plate are not meant for the scene.
    void mousePressEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
};

} // namespace lumorph::studio
