#pragma once

#include <optional>
#include <utility>
#include <vector>

#include <QString>
#include <QWidget>

#include "app/studio/viewport/body_marks.h"
#include "core/loop/pose_stream.h"
#include "core/render/viewport/view_camera.h"

namespace lumorph::studio {

/// Tracked bodies in the room, each with its axes x (red), y (green) and z (blue), over a grid of the ground (the plane
/// y = 0 of the frame `world`) and a line down to it. A drag beside them turns the view, a double click looks from
/// above and back again.
///
/// Bodies that a person may move are dragged by the left button (at their height, or upright where the view is nearly
/// level) and turned by the right; the wheel lifts them. With the keyboard: Space chooses the next one, arrow keys move
/// it by 1 cm along the axis that points that way, PageUp and PageDown lift it, both ten times as far with Ctrl, comma
/// and full stop turn it by 5 degrees.
class RoomView : public QWidget {
    Q_OBJECT
public:
    struct Body {
        QString name;
        QString source; ///< address of its tracker: others may have bodies of that name
        Pose pose;
        bool seen = true;
        bool movable = false;
    };

    explicit RoomView(QWidget* parent = nullptr);
    void show(std::vector<Body> bodies);
    [[nodiscard]] const ViewCamera& camera() const noexcept { return camera_; }

    [[nodiscard]] QSize sizeHint() const override;
    [[nodiscard]] QSize minimumSizeHint() const override;

signals:
    /// A person moves a body: by so many metres, and about the vertical by so many radians, against the clock as seen
    /// from above.
    void moved(int body, const glm::dvec3& way, double turn);

protected:
    bool event(QEvent* event) override;
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void focusInEvent(QFocusEvent* event) override;
    void focusOutEvent(QFocusEvent* event) override;

private:
    /// What the pressed button does until it is released.
    enum class Hold { nothing, view, body };

    [[nodiscard]] bool isChosen(const Body& body) const;

    [[nodiscard]] glm::vec2 viewSize() const;
    [[nodiscard]] std::optional<int> movableAt(const QPointF& at) const;
    [[nodiscard]] std::optional<int> chosen() const;
    void chooseNext();
    void keepInSight();
    void lookAtAll();
    void drag(const QPointF& from, const QPointF& to);
    void letGo();

    std::vector<Body> bodies_;
    ViewCamera camera_;
    Box inSight_; ///< metres; grows and shrinks in steps, so that the picture does not breathe with every move
    /// Source and name of the body that is dragged, or that keys move.
    std::pair<QString, QString> chosen_;
    Hold hold_ = Hold::nothing;
    Qt::MouseButton button_ = Qt::NoButton;
    QPointF last_;
    bool ringed_ = false; ///< the focus came by key
};

} // namespace lumorph::studio
