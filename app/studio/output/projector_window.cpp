#include "app/studio/output/projector_window.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QCloseEvent>
#include <QKeyEvent>
#include <QPainter>
#include <QScreen>

namespace lumorph::studio {
namespace {

constexpr double kRoomOfScreen = 0.8; ///< a new window leaves some of the screen free

/// Logical size of so many pixels of the screen.
QSize logical(QSize pixels, double ratio) {
    return {static_cast<int>(std::ceil(pixels.width() / ratio)), static_cast<int>(std::ceil(pixels.height() / ratio))};
}

} // namespace

ProjectorWindow::ProjectorWindow(ShowFeed& feed, Commands& commands, std::size_t number)
    : feed_(feed), number_(number), id_(feed.add()) {
    setObjectName(QString("output.projector%1").arg(number + 1));
    setAttribute(Qt::WA_OpaquePaintEvent);
    setAttribute(Qt::WA_NoSystemBackground);
    setMinimumSize(160, 100);
    // Shortcuts sleep in a window that does not have their actions.
    for (const Commands::Entry& entry : commands.all()) addAction(entry.action);
    connect(&commands, &Commands::added, this, [this](QAction* action) { addAction(action); });
    connect(&feed_, &ShowFeed::shown, this, [this] { update(); });
    identifying_.setSingleShot(true);
    connect(&identifying_, &QTimer::timeout, this, [this] { update(); });
}

ProjectorWindow::~ProjectorWindow() { feed_.drop(id_); }

void ProjectorWindow::setProjector(const QString& name, QSize size) {
    const bool first = size_.isEmpty();
    name_ = name;
    showTitle();
    if (size == size_) return;
    size_ = size;
    setPattern(pattern_);
    ask();
    showTitle();
    if (!first || isFullScreen()) return;
    const QSize room = screen()->availableSize() * kRoomOfScreen;
    resize(logical(size_, devicePixelRatioF()).boundedTo(room));
}

void ProjectorWindow::ask() {
    if (isMinimized() || !calibrationPicture_.isNull()) return feed_.drop(id_);
    ShowView view;
    view.kind = ShowView::Kind::projector;
    view.projector = number_;
    view.exact = true;
    feed_.want(id_, view, size_);
}

void ProjectorWindow::showTitle() {
    setWindowTitle(tr("%1 (%2 × %3) - Lumorph").arg(name_).arg(size_.width()).arg(size_.height()));
}

void ProjectorWindow::setPattern(TestPattern pattern) {
    pattern_ = pattern;
    patternPicture_ = pattern == TestPattern::none ? QImage() : testPattern(pattern, size_);
    update();
}

void ProjectorWindow::setScaled(bool on) {
    scaled_ = on;
    update();
}

void ProjectorWindow::identify(int milliseconds) {
    identifying_.start(milliseconds);
    update();
}

void ProjectorWindow::setCalibrationPicture(const QImage& picture, quint64 ticket) {
    const bool isOther = picture.isNull() != calibrationPicture_.isNull();
    calibrationPicture_ = picture;
    ticket_ = picture.isNull() ? 0 : ticket;
    if (isOther) ask();
    update();
}

QString ProjectorWindow::calibrationProblem() const {
    if (size_.isEmpty()) return tr("there is no such projector");
    if (!isVisible() || isMinimized()) return tr("its window is not shown: open it on the projector's screen");
    const QSize there = pixels();
    const QSize more = there - size_;
    const auto fits = [](int pixels) { return pixels == 0 || pixels == 1; }; // as at some desktop scales
    if (fits(more.width()) && fits(more.height())) return {};
    return tr("its window has %1 × %2 pixels, the projector %3 × %4: show it on all of the projector's screen, in that "
              "screen's own resolution")
        .arg(there.width())
        .arg(there.height())
        .arg(size_.width())
        .arg(size_.height());
}

/// Qt hands a window's picture to the display server when paintEvent has returned, and says no more of it. What is
/// called from the queue comes after that; and a server that gives a pixel back has worked off what came before.
void ProjectorWindow::tellShown(quint64 ticket) {
    if (ticket != ticket_) return; // painted twice: told already, and a later one is not painted yet
    screen()->grabWindow(winId(), 0, 0, 1, 1);
    ticket_ = 0;
    emit calibrationShown(ticket);
}

QImage ProjectorWindow::picture() const {
    if (!calibrationPicture_.isNull()) return calibrationPicture_;
    if (identifying_.isActive()) return numberPicture(static_cast<int>(number_) + 1, size_);
    return pattern_ == TestPattern::none ? feed_.picture(id_) : patternPicture_;
}

QSize ProjectorWindow::pixels() const {
    const double ratio = devicePixelRatioF();
    return {static_cast<int>(std::lround(width() * ratio)), static_cast<int>(std::lround(height() * ratio))};
}

void ProjectorWindow::coverScreen(QScreen* screen) {
    // Full screen goes to the screen on which the window is.
    showNormal();
    setScreen(screen);
    setGeometry(screen->geometry());
    showFullScreen();
    raise();
}

void ProjectorWindow::leaveScreen() {
    if (!isFullScreen()) return;
    showNormal();
    const QSize room = screen()->availableSize() * kRoomOfScreen;
    resize(logical(size_, devicePixelRatioF()).boundedTo(room));
    emit leftScreen();
}

void ProjectorWindow::paintEvent(QPaintEvent* /*event*/) {
    if (ticket_ != 0)
        QMetaObject::invokeMethod(
            this, [this, ticket = ticket_] { tellShown(ticket); }, Qt::QueuedConnection);
    QPainter painter(this);
    // In pixels of the screen: the picture is copied, whatever the desktop's scale.
    const double ratio = devicePixelRatioF();
    painter.scale(1.0 / ratio, 1.0 / ratio);
    const QSize room = pixels();
    const QImage shown = picture();
    if (shown.isNull()) {
        painter.fillRect(QRect(QPoint(0, 0), room), Qt::black);
        return;
    }
    QRect box(QPoint((room.width() - shown.width()) / 2, (room.height() - shown.height()) / 2), shown.size());
    if (scaled_ && calibrationPicture_.isNull()) {
        const QSize fitting = shown.size().scaled(room, Qt::KeepAspectRatio);
        box = QRect(QPoint((room.width() - fitting.width()) / 2, (room.height() - fitting.height()) / 2), fitting);
    }
    // At some scales a window is counted a pixel larger than it is.
    const QRect all(QPoint(0, 0), room + QSize(1, 1));
    if (!box.contains(QRect(QPoint(0, 0), room))) painter.fillRect(all, Qt::black);
    if (box.size() == shown.size()) {
        painter.drawImage(box.topLeft(), shown);
    } else {
        painter.setRenderHint(QPainter::SmoothPixmapTransform);
        painter.drawImage(box, shown);
    }
}

void ProjectorWindow::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    if (isFullScreen()) emit covered();
}

void ProjectorWindow::changeEvent(QEvent* event) {
    QWidget::changeEvent(event);
    if (event->type() != QEvent::WindowStateChange) return;
    ask();
    // The pointer would be projected.
    isFullScreen() ? setCursor(Qt::BlankCursor) : unsetCursor();
    // The size may have come before the state.
    if (isFullScreen()) QMetaObject::invokeMethod(this, &ProjectorWindow::covered, Qt::QueuedConnection);
}

bool ProjectorWindow::event(QEvent* event) {
    // Esc is this window's; a second one is still seen by STOP, which watches the whole program.
    if (event->type() == QEvent::ShortcutOverride && static_cast<QKeyEvent*>(event)->key() == Qt::Key_Escape) {
        event->accept();
        return true;
    }
    return QWidget::event(event);
}

void ProjectorWindow::keyPressEvent(QKeyEvent* event) {
    if (event->key() == Qt::Key_Escape)
        leaveScreen();
    else
        QWidget::keyPressEvent(event);
}

void ProjectorWindow::closeEvent(QCloseEvent* event) {
    QWidget::closeEvent(event);
    emit closed();
}

} // namespace lumorph::studio
