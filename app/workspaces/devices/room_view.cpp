#include "app/workspaces/devices/room_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>

#include "app/studio/look/palette.h"
#include "app/studio/viewport/view_marks.h"
#include "app/studio/widgets/plot_axes.h"

namespace lumorph::studio {
namespace {

constexpr int kRoomHeight = 240;
constexpr double kGrasp = 16.0; ///< pixels from a body
constexpr double kStep = 0.01;  ///< metres
constexpr double kTurn = 5.0 * M_PI / 180.0;
constexpr double kTurnPerPixel = 0.5 * M_PI / 180.0;
constexpr Angle kYaw = Angle::degrees(25.0), kPitch = Angle::degrees(28.0);
constexpr Angle kLevel = Angle::degrees(20.0); ///< below it a drag is upright: the horizon is too near
constexpr float kTablet = 0.15F;               ///< metres from the origin that are always in sight
constexpr float kMost = 50.0F;                 ///< metres; what a tracker says beyond is not followed
constexpr double kFaint = 0.35;
constexpr int kMostSquares = 8;

glm::vec3 placeOf(const RoomView::Body& body) { return glm::vec3(body.pose.position); }
QPointF asPoint(const glm::vec2& at) { return {static_cast<double>(at.x), static_cast<double>(at.y)}; }
glm::vec2 asVector(const QPointF& at) { return {static_cast<float>(at.x()), static_cast<float>(at.y())}; }

/// Lines in world metres, as a camera sees them.
class RoomPainter {
public:
    RoomPainter(QPainter& painter, const ViewCamera& camera, const glm::vec2& size)
        : painter_(painter), camera_(camera), size_(size) {}

    void line(const glm::vec3& from, const glm::vec3& to) const {
        const auto a = pixelOf(camera_, from, size_), b = pixelOf(camera_, to, size_);
        if (a && b) painter_.drawLine(asPoint(*a), asPoint(*b));
    }
    void ring(const glm::vec3& at, double pixels) const {
        if (const auto middle = pixelOf(camera_, at, size_)) painter_.drawEllipse(asPoint(*middle), pixels, pixels);
    }

private:
    QPainter& painter_;
    const ViewCamera& camera_;
    glm::vec2 size_;
};

float squareOf(const Box& room) {
    const glm::vec3 size = room.size();
    return static_cast<float>(niceTick(static_cast<double>(std::max(size.x, size.z)), kMostSquares));
}

void drawGround(QPainter& painter, const RoomPainter& room, const Box& inSight) {
    const Palette& colors = currentPalette();
    const float square = squareOf(inSight);
    const auto first = [square](float at) { return static_cast<int>(std::floor(at / square)); };
    const auto last = [square](float at) { return static_cast<int>(std::ceil(at / square)); };
    const int left = first(inSight.min.x), right = last(inSight.max.x);
    const int back = first(inSight.min.z), front = last(inSight.max.z);
    const auto at = [square](int x, int z) {
        return square * glm::vec3(static_cast<float>(x), 0.0F, static_cast<float>(z));
    };
    painter.setPen(QPen(colors.border, 1));
    for (int x = left; x <= right; ++x) room.line(at(x, back), at(x, front));
    for (int z = back; z <= front; ++z) room.line(at(left, z), at(right, z));
    const std::array<QColor, 3> axes = axisColors(colors);
    painter.setPen(QPen(axes[0], 2));
    room.line(at(0, 0), at(right, 0));
    painter.setPen(QPen(axes[2], 2));
    room.line(at(0, 0), at(0, front));
    painter.setPen(colors.textMuted);
    painter.drawText(QPointF(10, 20), QString("Grid %1 m").arg(static_cast<double>(square)));
}

/// What one press of a key does to a body as the view shows it: to the right, towards the viewer, up; and its turn.
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

/// What a key with its modifiers moves: Ctrl takes longer steps, but Ctrl+comma and its like are the window's.
std::optional<KeyMove> moveOf(const QKeyEvent& event) {
    const bool farther = event.modifiers().testFlag(Qt::ControlModifier);
    if ((event.modifiers() & (Qt::AltModifier | Qt::MetaModifier)) != 0) return std::nullopt;
    std::optional<KeyMove> move = moveOf(event.key());
    if (!move || !farther) return move;
    if (move->turn != 0.0) return std::nullopt;
    move->way *= 10.0;
    return move;
}

bool isNext(const QKeyEvent& event) { return event.key() == Qt::Key_Space && event.modifiers() == Qt::NoModifier; }

/// A way as the view shows it, along the world's axes that come nearest to it.
glm::dvec3 alongAxes(const glm::dvec3& way, const ViewCamera& camera) {
    const double turn = 0.5 * M_PI * std::round(camera.yaw.inDegrees() / 90.0);
    const double c = std::cos(turn), s = std::sin(turn);
    return {c * way.x + s * way.z, way.y, -s * way.x + c * way.z};
}

} // namespace

RoomView::RoomView(QWidget* parent) : QWidget(parent) {
    setAccessibleName("Tracked bodies in the room");
    setToolTip("Red, green and blue are the axes x, y and z of each body; a line leads down to the ground. The world's "
               "own axes x and z lie on the grid and begin at its origin. Drag beside the bodies to turn the view, "
               "double click to look from above and back. A simulated body has a ring: drag it, turn it with the right "
               "button, lift it with the wheel.");
    setAccessibleDescription("Space chooses a simulated body; arrow keys move it, PageUp and PageDown lift it, with "
                             "Ctrl ten times as far; comma and full stop turn it.");
    setMouseTracking(true);
    setContextMenuPolicy(Qt::PreventContextMenu);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    camera_.yaw = kYaw;
    camera_.pitch = kPitch;
}

void RoomView::show(std::vector<Body> bodies) {
    bodies_ = std::move(bodies);
    if (hold_ == Hold::body && !chosen()) letGo(); // its tracker is gone
    const bool any = std::ranges::any_of(bodies_, &Body::movable);
    setFocusPolicy(any ? Qt::StrongFocus : Qt::NoFocus);
    if (any && !chosen()) chooseNext();
    if (hold_ == Hold::nothing) keepInSight(); // else the room stays under the pointer
    update();
}

void RoomView::keepInSight() {
    Box needed{glm::vec3(-kTablet, 0.0F, -kTablet), glm::vec3(kTablet, 0.0F, kTablet)};
    for (const Body& body : bodies_) {
        const glm::vec3 at = glm::clamp(placeOf(body), -kMost, kMost);
        needed.include(at);
        needed.include(glm::vec3(-at.x, 0.0F, -at.z)); // the ground lies evenly around the origin
    }
    // And is as wide as it is deep, so that it is seen as a ground from every side.
    const float reach = std::max(needed.max.x, needed.max.z);
    needed.include(glm::vec3(reach, 0.0F, reach));
    needed.include(glm::vec3(-reach, 0.0F, -reach));
    const auto longest = [](const Box& box) {
        const glm::vec3 size = box.size();
        return std::max({size.x, size.y, size.z});
    };
    const bool fits = !inSight_.empty() && inSight_.min == glm::min(inSight_.min, needed.min) &&
                      inSight_.max == glm::max(inSight_.max, needed.max);
    if (fits && longest(inSight_) < 3.0F * longest(needed)) return;
    const float step = squareOf(needed);
    inSight_ = {step * glm::floor(needed.min / step), step * glm::ceil(needed.max / step)};
    lookAtAll();
}

void RoomView::lookAtAll() {
    if (inSight_.empty() || height() == 0) return;
    const glm::vec2 size = viewSize();
    camera_ = framed(camera_, inSight_, size.x / size.y, 0.85F);
    update();
}

glm::vec2 RoomView::viewSize() const { return {static_cast<float>(width()), static_cast<float>(height())}; }

std::optional<int> RoomView::movableAt(const QPointF& at) const {
    std::optional<int> nearest;
    double least = kGrasp;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const auto pixel = pixelOf(camera_, placeOf(bodies_[i]), viewSize());
        if (!bodies_[i].movable || !pixel) continue;
        const double off = QLineF(at, asPoint(*pixel)).length();
        if (off > least) continue;
        least = off;
        nearest = static_cast<int>(i);
    }
    return nearest;
}

bool RoomView::isChosen(const Body& body) const { return body.movable && chosen_ == std::pair(body.source, body.name); }

std::optional<int> RoomView::chosen() const {
    const auto found = std::ranges::find_if(bodies_, [this](const Body& body) { return isChosen(body); });
    if (found == bodies_.end()) return std::nullopt;
    return static_cast<int>(found - bodies_.begin());
}

void RoomView::chooseNext() {
    const std::size_t count = bodies_.size();
    const std::size_t from = chosen() ? static_cast<std::size_t>(*chosen()) + 1 : 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Body& body = bodies_[(from + i) % count];
        if (!body.movable) continue;
        chosen_ = {body.source, body.name};
        return update();
    }
}

void RoomView::mousePressEvent(QMouseEvent* event) {
    const bool left = event->button() == Qt::LeftButton;
    if (hold_ != Hold::nothing || (!left && event->button() != Qt::RightButton)) return;
    const auto at = movableAt(event->position());
    if (!at && !left) return;
    hold_ = at ? Hold::body : Hold::view;
    button_ = event->button();
    last_ = event->position();
    if (at) chosen_ = {bodies_[static_cast<std::size_t>(*at)].source, bodies_[static_cast<std::size_t>(*at)].name};
    setCursor(Qt::ClosedHandCursor);
    update();
}

void RoomView::mouseMoveEvent(QMouseEvent* event) {
    const QPointF at = event->position();
    if (hold_ == Hold::nothing) {
        movableAt(at) ? setCursor(Qt::OpenHandCursor) : unsetCursor();
        return;
    }
    const QPointF from = std::exchange(last_, at);
    if (hold_ == Hold::view) {
        camera_ = orbited(camera_, asVector(at - from), viewSize());
        camera_.pitch = Angle::radians(std::max(camera_.pitch.inRadians(), 0.0)); // never from below the ground
        return lookAtAll();
    }
    if (button_ == Qt::RightButton)
        emit moved(*chosen(), glm::dvec3(0.0), -kTurnPerPixel * (at - from).x());
    else
        drag(from, at);
}

/// Along the plane through the body that is level, or, where the view is nearly level itself, upright and facing it.
void RoomView::drag(const QPointF& from, const QPointF& to) {
    const int dragged = *chosen();
    const glm::vec3 body = placeOf(bodies_[static_cast<std::size_t>(dragged)]);
    const auto yaw = static_cast<float>(camera_.yaw.inRadians());
    const glm::vec3 normal = camera_.pitch.inRadians() > kLevel.inRadians()
                                 ? glm::vec3(0.0F, 1.0F, 0.0F)
                                 : glm::vec3(std::sin(yaw), 0.0F, std::cos(yaw));
    const auto place = [&](const QPointF& pixel) -> std::optional<glm::vec3> {
        const Ray ray = rayThrough(camera_, asVector(pixel), viewSize());
        const float slope = glm::dot(ray.direction, normal);
        const float way = glm::dot(body - ray.origin, normal) / slope;
        if (!(way > 0.0F) || !std::isfinite(way)) return std::nullopt; // towards the horizon
        return ray.origin + way * ray.direction;
    };
    const auto before = place(from), after = place(to);
    if (before && after) emit moved(dragged, glm::dvec3(*after - *before), 0.0);
}

void RoomView::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() == button_) letGo();
}

void RoomView::letGo() {
    hold_ = Hold::nothing;
    button_ = Qt::NoButton;
    unsetCursor();
}

void RoomView::mouseDoubleClickEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton || movableAt(event->position())) return mousePressEvent(event);
    const bool above = camera_.pitch.inDegrees() > 89.0;
    camera_.yaw = above ? kYaw : Angle::degrees(0.0);
    camera_.pitch = above ? kPitch : Angle::degrees(90.0);
    lookAtAll();
}

void RoomView::wheelEvent(QWheelEvent* event) {
    const auto body = movableAt(event->position());
    if (!body) return event->ignore(); // the dock scrolls
    emit moved(*body, {0.0, kStep * event->angleDelta().y() / 120.0, 0.0}, 0.0);
    event->accept();
}

bool RoomView::event(QEvent* event) {
    // These keys belong to the view while it has the keyboard, whatever shortcuts say.
    if (event->type() == QEvent::ShortcutOverride && chosen()) {
        const auto& key = *static_cast<QKeyEvent*>(event);
        if (moveOf(key) || isNext(key)) {
            event->accept();
            return true;
        }
    }
    return QWidget::event(event);
}

void RoomView::keyPressEvent(QKeyEvent* event) {
    const auto body = chosen();
    if (body && isNext(*event)) return hold_ == Hold::body ? void() : chooseNext();
    const auto move = moveOf(*event);
    if (!body || !move) return QWidget::keyPressEvent(event);
    emit moved(*body, alongAxes(move->way, camera_), move->turn);
}

void RoomView::focusInEvent(QFocusEvent* event) {
    ringed_ = cameByKey(*event);
    update();
    QWidget::focusInEvent(event);
}

void RoomView::focusOutEvent(QFocusEvent* event) {
    ringed_ = false;
    update();
    QWidget::focusOutEvent(event);
}

void RoomView::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    lookAtAll();
}

QSize RoomView::sizeHint() const { return {240, kRoomHeight}; }
QSize RoomView::minimumSizeHint() const { return {160, kRoomHeight}; }

void RoomView::paintEvent(QPaintEvent* /*event*/) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const QRectF box = QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5);
    painter.setPen(QPen(colors.line, 1));
    painter.setBrush(colors.sunken);
    painter.drawRoundedRect(box, 4, 4);
    painter.setClipRect(box);
    const RoomPainter room(painter, camera_, viewSize());
    if (!inSight_.empty()) drawGround(painter, room, inSight_);
    std::vector<BodyMark> marks;
    for (const Body& body : bodies_) {
        const glm::vec3 at = placeOf(body);
        painter.setBrush(Qt::NoBrush);
        painter.setPen(QPen(colors.textMuted, 1, Qt::DotLine));
        room.line(at, {at.x, 0.0F, at.z});
        if (body.movable) {
            painter.setPen(isChosen(body) ? QPen(colors.accentText, 2.0) : QPen(colors.border, 1.0));
            room.ring(at, 9.0);
        }
        marks.push_back({body.name, at, glm::quat(body.pose.rotation), body.seen ? 1.0 : kFaint});
    }
    paintBodies(painter, size(), camera_, marks, colors);
    if (ringed_) paintFocusRing(painter, size(), colors);
}

} // namespace lumorph::studio
