#include "app/workspaces/devices/top_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>

#include "app/studio/look/palette.h"
#include "app/studio/viewport/view_marks.h"

namespace lumorph::studio {
namespace {

constexpr int kHeight = 200;
constexpr double kLeastReach = 0.5, kMostReach = 50.0;
constexpr double kMargin = 14.0;
constexpr double kAxis = 18.0;  ///< pixels of an axis that lies flat
constexpr double kGrasp = 16.0; ///< pixels from a body
constexpr double kStep = 0.01;  ///< metres
constexpr double kTurn = 5.0 * M_PI / 180.0;
constexpr double kTurnPerPixel = 0.5 * M_PI / 180.0;
const QColor kAxisColors[] = {QColor(0xe0, 0x55, 0x55), QColor(0x4c, 0xb0, 0x5a), QColor(0x55, 0x8c, 0xf0)};

/// Of world metres to the widget's pixels.
struct TopMap {
    QPointF origin;
    double scale = 1.0;
    [[nodiscard]] QPointF of(const glm::dvec3& at) const { return origin + scale * QPointF(at.x, at.z); }
};

void drawGround(QPainter& painter, const TopMap& map, const QRectF& box) {
    const Palette& colors = currentPalette();
    painter.setPen(QPen(colors.line, 1));
    painter.drawLine(QPointF(map.origin.x(), box.top() + 1), QPointF(map.origin.x(), box.bottom() - 1));
    painter.drawLine(QPointF(box.left() + 1, map.origin.y()), QPointF(box.right() - 1, map.origin.y()));
    // One length to compare with: the longest of these that is not too long.
    double length = 0.1;
    for (const double next : {0.2, 0.5, 1.0, 2.0, 5.0, 10.0})
        if (next * map.scale < 0.3 * box.width()) length = next;
    const QPointF from(box.left() + kMargin, box.bottom() - kMargin);
    painter.setPen(QPen(colors.textMuted, 1));
    painter.drawLine(from, from + QPointF(length * map.scale, 0));
    painter.drawText(from + QPointF(0, -4), QString("%1 m").arg(length));
    painter.drawText(QRectF(box).adjusted(kMargin, 4, -kMargin, 0), Qt::AlignRight | Qt::AlignTop, "x →  z ↓");
}

/// What one press of a key does.
struct KeyMove {
    glm::dvec3 way{0.0};
    double turn = 0.0;
};

std::optional<KeyMove> moveOf(int key) {
    switch (key) {
    case Qt::Key_Left:
        return KeyMove{{-kStep, 0, 0}, 0};
    case Qt::Key_Right:
        return KeyMove{{kStep, 0, 0}, 0};
    case Qt::Key_Up:
        return KeyMove{{0, 0, -kStep}, 0};
    case Qt::Key_Down:
        return KeyMove{{0, 0, kStep}, 0};
    case Qt::Key_PageUp:
        return KeyMove{{0, kStep, 0}, 0};
    case Qt::Key_PageDown:
        return KeyMove{{0, -kStep, 0}, 0};
    case Qt::Key_Comma:
        return KeyMove{{}, kTurn};
    case Qt::Key_Period:
        return KeyMove{{}, -kTurn};
    default:
        return std::nullopt;
    }
}

void drawBody(QPainter& painter, const TopMap& map, const TopView::Body& body, bool chosen) {
    const Palette& colors = currentPalette();
    const QPointF at = map.of(body.pose.position);
    painter.setOpacity(body.seen ? 1.0 : 0.35);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 way(0.0);
        way[axis] = 1.0;
        way = body.pose.rotation * way;
        painter.setPen(QPen(kAxisColors[axis], 2.0, Qt::SolidLine, Qt::RoundCap));
        painter.drawLine(at, at + kAxis * QPointF(way.x, way.z));
    }
    if (body.movable) {
        painter.setBrush(Qt::NoBrush);
        painter.setPen(QPen(chosen ? colors.accentText : colors.border, chosen ? 2.0 : 1.0));
        painter.drawEllipse(at, 9.0, 9.0);
    }
    painter.setPen(Qt::NoPen);
    painter.setBrush(colors.text);
    painter.drawEllipse(at, 3.0, 3.0);
    painter.setPen(colors.text);
    painter.drawText(at + QPointF(11, -9), painter.fontMetrics().elidedText(body.name, Qt::ElideRight, 96));
    painter.setOpacity(1.0);
}

} // namespace

TopView::TopView(QWidget* parent) : QWidget(parent) {
    setAccessibleName("Tracked bodies from above");
    setToolTip(
        "From above, in the world's frame. Red, green and blue are the axes x, y and z of each body; a body that "
        "is upright shows its green one as a dot. The grey cross is the world's origin. A simulated body has a ring: "
        "drag it, turn it with the right button, lift it with the wheel.");
    setAccessibleDescription("Space chooses a simulated body; arrow keys move it, PageUp and PageDown lift it, comma "
                             "and full stop turn it; with Ctrl ten times as much.");
    setMouseTracking(true);
    setContextMenuPolicy(Qt::PreventContextMenu);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

void TopView::show(std::vector<Body> bodies) {
    bodies_ = std::move(bodies);
    const bool any = std::ranges::any_of(bodies_, &Body::movable);
    setFocusPolicy(any ? Qt::StrongFocus : Qt::NoFocus);
    if (any && !chosen()) chooseNext();
    update();
    if (dragged_) return; // the ground stays under the pointer
    double farthest = 0.0;
    for (const Body& body : bodies_)
        farthest = std::max({farthest, std::abs(body.pose.position.x), std::abs(body.pose.position.z)});
    // In steps, so that the picture does not breathe with every move.
    while (reach_ < 1.05 * farthest && reach_ < kMostReach) reach_ *= 2.0;
    while (reach_ > kLeastReach && reach_ > 4.0 * farthest) reach_ *= 0.5;
}

QPointF TopView::pointOf(const Pose& pose) const {
    const TopMap map{QRectF(rect()).center(), 1.0 / metresPerPixel()};
    return map.of(pose.position);
}

double TopView::metresPerPixel() const { return reach_ / (0.5 * std::min(width(), height()) - kMargin); }

std::optional<int> TopView::movableAt(const QPointF& at) const {
    std::optional<int> nearest;
    double least = kGrasp;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const double off = QLineF(at, pointOf(bodies_[i].pose)).length();
        if (!bodies_[i].movable || off > least) continue;
        least = off;
        nearest = static_cast<int>(i);
    }
    return nearest;
}

std::optional<int> TopView::chosen() const {
    const auto found =
        std::ranges::find_if(bodies_, [this](const Body& body) { return body.movable && body.name == chosen_; });
    if (found == bodies_.end()) return std::nullopt;
    return static_cast<int>(found - bodies_.begin());
}

void TopView::chooseNext() {
    const std::size_t count = bodies_.size();
    const std::size_t from = chosen() ? static_cast<std::size_t>(*chosen()) + 1 : 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Body& body = bodies_[(from + i) % count];
        if (!body.movable) continue;
        chosen_ = body.name;
        return update();
    }
}

void TopView::mousePressEvent(QMouseEvent* event) {
    const bool used = event->button() == Qt::LeftButton || event->button() == Qt::RightButton;
    const auto body = movableAt(event->position());
    if (dragged_ || !used || !body) return;
    dragged_ = body;
    button_ = event->button();
    last_ = event->position();
    chosen_ = bodies_[static_cast<std::size_t>(*body)].name;
    setCursor(Qt::ClosedHandCursor);
    update();
}

void TopView::mouseMoveEvent(QMouseEvent* event) {
    const QPointF at = event->position();
    if (!dragged_) {
        movableAt(at) ? setCursor(Qt::OpenHandCursor) : unsetCursor();
        return;
    }
    const QPointF by = at - std::exchange(last_, at);
    if (button_ == Qt::RightButton)
        emit moved(*dragged_, glm::dvec3(0.0), -kTurnPerPixel * by.x());
    else
        emit moved(*dragged_, metresPerPixel() * glm::dvec3(by.x(), 0.0, by.y()), 0.0);
}

void TopView::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() != button_) return;
    dragged_.reset();
    button_ = Qt::NoButton;
    unsetCursor();
}

void TopView::wheelEvent(QWheelEvent* event) {
    const auto body = movableAt(event->position());
    if (!body) return event->ignore(); // the dock scrolls
    emit moved(*body, {0.0, kStep * event->angleDelta().y() / 120.0, 0.0}, 0.0);
    event->accept();
}

bool TopView::event(QEvent* event) {
    // These keys belong to the view while it has the keyboard, whatever shortcuts say.
    if (event->type() == QEvent::ShortcutOverride && chosen()) {
        const int key = static_cast<QKeyEvent*>(event)->key();
        if (moveOf(key) || key == Qt::Key_Space) {
            event->accept();
            return true;
        }
    }
    return QWidget::event(event);
}

void TopView::keyPressEvent(QKeyEvent* event) {
    const auto body = chosen();
    if (body && event->key() == Qt::Key_Space) return chooseNext();
    const auto move = moveOf(event->key());
    if (!body || !move) return QWidget::keyPressEvent(event);
    const double times = event->modifiers().testFlag(Qt::ControlModifier) ? 10.0 : 1.0;
    emit moved(*body, times * move->way, times * move->turn);
}

void TopView::focusInEvent(QFocusEvent* event) {
    const auto why = event->reason();
    ringed_ = why == Qt::TabFocusReason || why == Qt::BacktabFocusReason || why == Qt::ShortcutFocusReason;
    update();
    QWidget::focusInEvent(event);
}

void TopView::focusOutEvent(QFocusEvent* event) {
    ringed_ = false;
    update();
    QWidget::focusOutEvent(event);
}

QSize TopView::sizeHint() const { return {240, kHeight}; }
QSize TopView::minimumSizeHint() const { return {160, kHeight}; }

void TopView::paintEvent(QPaintEvent* /*event*/) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const QRectF box = QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5);
    painter.setPen(QPen(colors.line, 1));
    painter.setBrush(colors.sunken);
    painter.drawRoundedRect(box, 4, 4);
    painter.setClipRect(box);
    const TopMap map{QRectF(rect()).center(), 1.0 / metresPerPixel()};
    drawGround(painter, map, box);
    for (const Body& body : bodies_) drawBody(painter, map, body, body.name == chosen_);
    if (ringed_) paintFocusRing(painter, size(), colors);
}

} // namespace lumorph::studio
