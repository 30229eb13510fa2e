#pragma once

#include <QWidget>
#include <glm/vec3.hpp>

namespace lumorph::studio {

/// From where light comes, as seen from above: the middle is straight overhead, the rim the horizon. Drag the point, or
/// use the arrow keys: left and right walk around, up and down climb and sink.
class DirectionDial : public QWidget {
    Q_OBJECT
public:
    explicit DirectionDial(QWidget* parent = nullptr);

    /// Towards the light, any length; below the horizon it shows at the rim.
    void setDirection(const glm::vec3& direction);
    [[nodiscard]] const glm::vec3& direction() const noexcept { return direction_; }
    [[nodiscard]] QSize sizeHint() const override { return {132, 132}; }
    [[nodiscard]] QSize minimumSizeHint() const override { return {96, 96}; }
    /// Where the point is drawn, widget pixels; for tests.
    [[nodiscard]] QPointF handle() const;

signals:
    void previewed(const glm::vec3& direction); ///< length 1
    void committed(const glm::vec3& direction);
    void reverted(); ///< Esc during a drag

protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

private:
    [[nodiscard]] double radius() const;
    void drag(const QPointF& at);

    glm::vec3 direction_{0.0F, 1.0F, 0.0F};
    glm::vec3 before_{0.0F, 1.0F, 0.0F};
    bool dragging_ = false;
};

} // namespace lumorph::studio
