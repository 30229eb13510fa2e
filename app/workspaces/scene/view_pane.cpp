#include "app/workspaces/scene/view_pane.h"

#include <cmath>
#include <utility>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>

#include "app/studio/look/palette.h"
#include "app/studio/shell/program_inputs.h"
#include "app/studio/viewport/view_marks.h"

namespace lumorph::studio {
namespace {

constexpr double kClickReach = 4.0; // pixels that a click may wander
constexpr int kPanePadding = 8;
constexpr int kPaneMargin = 12;
constexpr int kCaptionHeight = 24;
constexpr int kLabelPixels = 17;
constexpr int kLabelOver = 44, kLabelOverHints = 118; ///< over the lower edge, to its middle
constexpr int kRoomBesideHints = 740; ///< from this width on what visitors find at the lower edge lies beside it

/// Arrow keys go around as the pointer does.
std::optional<QPointF> stepOf(int key) {
    switch (key) {
    case Qt::Key_Left:
        return QPointF(-1.0, 0.0);
    case Qt::Key_Right:
        return QPointF(1.0, 0.0);
    case Qt::Key_Up:
        return QPointF(0.0, -1.0);
    case Qt::Key_Down:
        return QPointF(0.0, 1.0);
    default:
        return std::nullopt;
    }
}

} // namespace

PaneCaption::PaneCaption(const QString& title, QWidget* parent) : QWidget(parent), title_(title) {
    setAttribute(Qt::WA_TransparentForMouseEvents);
    move(kPaneMargin, kPaneMargin);
    setText(title, {});
}

void PaneCaption::setText(const QString& title, const QString& state, bool live) {
    const bool same = title == title_ && state == state_ && live == live_;
    title_ = title;
    state_ = state;
    live_ = live;
    setAccessibleName(state.isEmpty() ? title : title + ": " + state);
    QFont bold = font();
    bold.setWeight(QFont::DemiBold);
    const int wide = QFontMetrics(bold).horizontalAdvance(title_) + 2 * kPanePadding +
                     (state_.isEmpty() ? 0 : kPanePadding + fontMetrics().horizontalAdvance(state_));
    if (size() != QSize(wide, kCaptionHeight)) resize(wide, kCaptionHeight);
    if (!same) update();
}

void PaneCaption::paintEvent(QPaintEvent* /*event*/) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    QColor plate = colors.panel;
    plate.setAlphaF(0.82F);
    painter.setPen(Qt::NoPen);
    painter.setBrush(plate);
    painter.drawRoundedRect(rect(), 5.0, 5.0);
    QFont bold = font();
    bold.setWeight(QFont::DemiBold);
    painter.setFont(bold);
    painter.setPen(colors.text);
    const QRect inside = rect().adjusted(kPanePadding, 0, -kPanePadding, 0);
    painter.drawText(inside, Qt::AlignLeft | Qt::AlignVCenter, title_);
    const int used = QFontMetrics(bold).horizontalAdvance(title_) + kPanePadding;
    painter.setFont(font());
    painter.setPen(live_ ? colors.accentText : colors.textMuted);
    painter.drawText(inside.adjusted(used, 0, 0, 0), Qt::AlignLeft | Qt::AlignVCenter, state_);
}

ViewPane::ViewPane(ShowFeed& feed, const ShowView& view, const QString& title, QWidget* parent)
    : QWidget(parent), feed_(feed), id_(feed.add()), bareId_(feed.add()), view_(view),
      caption_(new PaneCaption(title, this)), waiting_(tr("Preparing the view...")) {
    setAttribute(Qt::WA_OpaquePaintEvent);
    setMouseTracking(true);
    setFocusPolicy(Qt::StrongFocus);
    setContextMenuPolicy(Qt::PreventContextMenu);
    setAccessibleName(title);
    connect(&feed_, &ShowFeed::shown, this, &ViewPane::take);
}

ViewPane::~ViewPane() {
    feed_.drop(id_);
    feed_.drop(bareId_);
}

void ViewPane::take() {
    if (!isVisible() || !active_) return;
    if (!before_.isNull() && !picture().isNull()) before_ = {};
    update();
}

QSize ViewPane::pixels() const {
    const double ratio = devicePixelRatioF();
    return {static_cast<int>(std::lround(width() * ratio)), static_cast<int>(std::lround(height() * ratio))};
}

void ViewPane::ask() {
    if (!active_ || !isVisible()) {
        asked_ = {};
        feed_.drop(id_);
        feed_.drop(bareId_);
        return;
    }
    asked_ = pixels();
    feed_.want(id_, view_, asked_);
    if (light_ == 1.0) return feed_.drop(bareId_);
    ShowView bare;
    bare.kind = ShowView::Kind::lab;
    bare.observer = view_.observer;
    bare.bend = view_.bend;
    bare.lit = false;
    feed_.want(bareId_, bare, asked_);
}

void ViewPane::setLight(double share) {
    const bool whole = light_ == 1.0;
    if (std::exchange(light_, share) == share) return;
    if (whole != (share == 1.0)) ask();
    update();
}

void ViewPane::setView(const ShowView& view) {
    if (view == view_) return;
    view_ = view;
    ask();
}

void ViewPane::setActive(bool active) {
    if (std::exchange(active_, active) == active) return;
    if (!active) {
        endDrag(false);
        if (isVisible()) before_ = picture();
    }
    ask();
}

void ViewPane::setWaiting(const QString& text) {
    if (std::exchange(waiting_, text) != text) update();
}

void ViewPane::setLabel(const QString& text) {
    if (std::exchange(label_, text) != text) update();
}

/// Over buttons and hints that lie at the lower edge; letters on a dark plate, as pictures are of any brightness.
void ViewPane::paintLabel(QPainter& painter) const {
    QFont large = font();
    large.setPixelSize(kLabelPixels);
    large.setWeight(QFont::DemiBold);
    const QFontMetrics metrics(large);
    const QString text = metrics.elidedText(label_, Qt::ElideRight, width() - 4 * kPanePadding);
    QRect plate(0, 0, metrics.horizontalAdvance(text) + 4 * kPanePadding, metrics.height() + 2 * kPanePadding);
    plate.moveCenter({width() / 2, height() - (width() < kRoomBesideHints ? kLabelOverHints : kLabelOver)});
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(Qt::NoPen);
    painter.setBrush(QColor(14, 18, 22, 168));
    painter.drawRoundedRect(plate, 12.0, 12.0);
    painter.setFont(large);
    painter.setPen(Qt::white);
    painter.drawText(plate, Qt::AlignCenter, text);
}

QRect ViewPane::pictureBox(const QSize& picture) const {
    const QSize room = pixels();
    // A projector's picture keeps its shape; all others fill the pane, also while they are of its size from before.
    const QSize shown = view_.kind == ShowView::Kind::projector ? picture.scaled(room, Qt::KeepAspectRatio) : room;
    return {QPoint((room.width() - shown.width()) / 2, (room.height() - shown.height()) / 2), shown};
}

void ViewPane::paintEvent(QPaintEvent* /*event*/) {
    // On another screen than the picture was asked for.
    if (active_ && asked_ != pixels()) ask();
    QPainter painter(this);
    const QImage shown = picture().isNull() ? before_ : picture();
    const Palette& colors = currentPalette();
    if (shown.isNull()) {
        painter.fillRect(rect(), colors.sunken);
        painter.setPen(colors.textMuted);
        painter.drawText(rect(), Qt::AlignCenter | Qt::TextWordWrap, waiting_);
        return;
    }
    const QRect box = pictureBox(shown.size());
    painter.save();
    // In pixels of the screen, so that a picture of the right size is copied and nothing else.
    const double ratio = devicePixelRatioF();
    painter.scale(1.0 / ratio, 1.0 / ratio);
    if (box.size() != pixels()) painter.fillRect(QRect(QPoint(0, 0), pixels()), colors.window);
    painter.setRenderHint(QPainter::SmoothPixmapTransform, box.size() != shown.size());
    painter.drawImage(box, shown);
    if (const QImage bare = light_ == 1.0 ? QImage() : feed_.picture(bareId_); !bare.isNull()) {
        painter.setOpacity(1.0 - light_);
        painter.drawImage(box, bare);
    }
    painter.restore();
    if (overlay_) overlay_->paint(painter, size());
    if (!label_.isEmpty()) paintLabel(painter);
    if (framed_) {
        painter.setPen(QPen(QColor(255, 255, 255, 110), 2.0));
        painter.setBrush(Qt::NoBrush);
        painter.drawRect(rect().adjusted(1, 1, -1, -1));
    }
    if (ringed_) paintFocusRing(painter, size(), colors);
}

void ViewPane::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    ask();
}

void ViewPane::showEvent(QShowEvent* event) {
    QWidget::showEvent(event);
    ask();
}

void ViewPane::hideEvent(QHideEvent* event) {
    QWidget::hideEvent(event);
    endDrag(false);
    ask();
}

void ViewPane::mousePressEvent(QMouseEvent* event) {
    // A second button during a drag changes nothing.
    if (drag_ != Drag::none) return;
    if (event->button() != Qt::LeftButton && event->button() != Qt::RightButton) return;
    button_ = event->button();
    modifiers_ = event->modifiers();
    pressedAt_ = last_ = event->position();
    const bool handled =
        overlay_ && button_ == Qt::LeftButton && overlay_->press(event->position(), size(), event->modifiers());
    drag_ = handled ? Drag::overlay : Drag::undecided;
}

void ViewPane::mouseMoveEvent(QMouseEvent* event) {
    const QPointF at = event->position();
    if (drag_ == Drag::none) {
        if (overlay_ && overlay_->hover(at, size())) update();
        return;
    }
    if (drag_ == Drag::overlay) {
        overlay_->drag(at, size(), event->modifiers());
        update();
        return;
    }
    if (drag_ == Drag::undecided) {
        if (QLineF(pressedAt_, at).length() < kClickReach) return;
        drag_ = Drag::view;
        setCursor(Qt::ClosedHandCursor);
        emit dragBegan(button_, modifiers_);
    }
    emit dragged(at - std::exchange(last_, at));
}

void ViewPane::mouseReleaseEvent(QMouseEvent* event) {
    if (drag_ == Drag::none || event->button() != button_) return;
    if (drag_ == Drag::undecided) {
        drag_ = Drag::none;
        if (button_ == Qt::LeftButton) emit clicked(event->position());
        return;
    }
    endDrag(true);
}

void ViewPane::endDrag(bool taken) {
    const Drag ended = std::exchange(drag_, Drag::none);
    unsetCursor();
    if (ended == Drag::overlay && overlay_) taken ? overlay_->release() : overlay_->cancel();
    if (ended == Drag::view) emit dragEnded(taken);
    update();
}

void ViewPane::mouseDoubleClickEvent(QMouseEvent* event) {
    if (event->button() == Qt::LeftButton) emit enlarged();
}

void ViewPane::wheelEvent(QWheelEvent* event) {
    const double notches = event->angleDelta().y() / 120.0;
    if (notches != 0.0 && drag_ == Drag::none) emit wheeled(notches);
    event->accept();
}

bool ViewPane::event(QEvent* event) {
    // Esc takes a drag back and does nothing else.
    if (event->type() == QEvent::ShortcutOverride) {
        const int key = static_cast<QKeyEvent*>(event)->key();
        const bool plain = !(static_cast<QKeyEvent*>(event)->modifiers() & ~Qt::KeypadModifier);
        if ((drag_ != Drag::none && key == Qt::Key_Escape) || stepOf(key) || (plain && isViewKey(key))) {
            event->accept();
            return true;
        }
    }
    return QWidget::event(event);
}

void ViewPane::keyPressEvent(QKeyEvent* event) {
    const bool dragging = drag_ == Drag::view || drag_ == Drag::overlay;
    if (event->key() == Qt::Key_Escape && dragging) return endDrag(false);
    if (isViewKey(event->key()) && !event->modifiers() && !event->isAutoRepeat()) emit viewKey(event->key());
    const auto step = stepOf(event->key());
    if (!step || drag_ != Drag::none) return QWidget::keyPressEvent(event);
    emit dragBegan(Qt::LeftButton, event->modifiers());
    emit dragged(*step * height() / 12.0); // 15 degrees
    emit dragEnded(true);
}

void ViewPane::focusInEvent(QFocusEvent* event) {
    ringed_ = cameByKey(*event);
    update();
    QWidget::focusInEvent(event);
}

void ViewPane::focusOutEvent(QFocusEvent* event) {
    ringed_ = false;
    update();
    QWidget::focusOutEvent(event);
}

} // namespace lumorph::studio
