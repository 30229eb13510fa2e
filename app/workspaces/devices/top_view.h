#pragma once

#include <optional>
#include <vector>

#include <QString>
#include <QWidget>

#include "core/loop/pose_stream.h"

namespace lumorph::studio {

/// Tracked bodies from above, in the frame `world`: x to the right, z, towards who stands before it, down. Each with
/// its axes x (red), y (green) and z (blue), as they look from there.
///
/// Bodies that a person may move are dragged along the ground by the left button and turned by the right; the wheel
/// lifts them. With the keyboard: Space chooses the next one, arrow keys move it by 1 cm, PageUp and PageDown lift it,
/// comma and full stop turn it by 5 degrees, each ten times as much with Ctrl.
class TopView : public QWidget {
    Q_OBJECT
public:
    struct Body {
        QString name;
        Pose pose;
        bool seen = true;
        bool movable = false;
    };

    explicit TopView(QWidget* parent = nullptr);
    void show(std::vector<Body> bodies);
    /// Where a body is drawn, widget pixels; for tests.
    [[nodiscard]] QPointF pointOf(const Pose& pose) const;
    /// Metres of one pixel.
    [[nodiscard]] double metresPerPixel() const;

    [[nodiscard]] QSize sizeHint() const override;
    [[nodiscard]] QSize minimumSizeHint() const override;

signals:
    /// A person moves a body: by so many metres, and about the vertical by so many radians, against the clock as seen
    /// from above.
    void moved(int body, const glm::dvec3& way, double turn);

protected:
    bool event(QEvent* event) override;
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void focusInEvent(QFocusEvent* event) override;
    void focusOutEvent(QFocusEvent* event) override;

private:
    [[nodiscard]] std::optional<int> movableAt(const QPointF& at) const;
    [[nodiscard]] std::optional<int> chosen() const;
    void chooseNext();

    std::vector<Body> bodies_;
    double reach_ = 0.5; ///< metres from the origin that are in sight, at least
    QString chosen_;     ///< name of the body that keys move
    std::optional<int> dragged_;
    Qt::MouseButton button_ = Qt::NoButton;
    QPointF last_;
    bool ringed_ = false; ///< the focus came by key
};

} // namespace lumorph::studio
