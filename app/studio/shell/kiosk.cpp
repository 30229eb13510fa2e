#include "app/studio/shell/kiosk.h"

#include <algorithm>
#include <utility>

#include <QAbstractButton>
#include <QApplication>
#include <QDialog>
#include <QDropEvent>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QTimer>

#include "app/studio/shell/pin_pad.h"

namespace lumorph::studio {
namespace {

constexpr Microseconds kTrust{20'000'000}; ///< for the one question that Resume may ask

bool isInput(QEvent::Type type) {
    switch (type) {
    case QEvent::KeyPress:
    case QEvent::KeyRelease:
    case QEvent::Shortcut:
    case QEvent::ShortcutOverride:
    case QEvent::InputMethod:
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonRelease:
    case QEvent::MouseButtonDblClick:
    case QEvent::Wheel:
    case QEvent::ContextMenu:
    case QEvent::TouchBegin:
    case QEvent::TouchUpdate:
    case QEvent::TouchEnd:
    case QEvent::TabletPress:
    case QEvent::TabletMove:
    case QEvent::TabletRelease:
    case QEvent::Gesture:
    case QEvent::GestureOverride:
    case QEvent::NativeGesture:
    case QEvent::DragEnter:
    case QEvent::DragMove:
    case QEvent::DragLeave:
    case QEvent::Drop:
    case QEvent::ToolTip:
    case QEvent::WhatsThis:
        return true;
    default:
        return false;
    }
}

bool isEscape(const QEvent& event) {
    const auto type = event.type();
    if (type != QEvent::KeyPress && type != QEvent::KeyRelease && type != QEvent::ShortcutOverride) return false;
    return static_cast<const QKeyEvent&>(event).key() == Qt::Key_Escape;
}

} // namespace

bool belongsTo(const QObject* object, const QObject* ancestor) {
    for (; object != nullptr; object = object->parent())
        if (object == ancestor) return true;
    return false;
}

Kiosk::Kiosk(QWidget& window, Settings& settings, const Clock& clock, const Buttons& buttons)
    : QObject(&window), window_(window), clock_(clock), pin_(settings, clock), buttons_(buttons) {}

Kiosk::~Kiosk() { open(); }

void Kiosk::requirePin(bool mayCancel, std::function<void()> chosen) {
    if (pin_.isSet()) return chosen();
    if (!padOpen()) pad_ = choosePin(window_, pin_, mayCancel, std::move(chosen));
}

/// One that left may not be deleted yet.
bool Kiosk::padOpen() const { return pad_ && pad_->isVisible(); }

void Kiosk::changePin() {
    if (!padOpen()) pad_ = choosePin(window_, pin_, true, {});
}

void Kiosk::close() {
    if (std::exchange(closed_, true)) return;
    shutWindows();
    trustUntil_ = {};
    window_.setFocus();
    // Installed last it is asked first.
    QCoreApplication::instance()->installEventFilter(this);
}

void Kiosk::open() {
    if (!std::exchange(closed_, false)) return;
    QCoreApplication::instance()->removeEventFilter(this);
    if (pad_) pad_->leave();
}

/// What is open would stay where no hand can close it, and a question keeps STOP from hearing a click.
void Kiosk::shutWindows() {
    while (QWidget* popup = QApplication::activePopupWidget())
        if (!popup->close()) break;
    for (QWidget* top : QApplication::topLevelWidgets())
        if (auto* dialog = qobject_cast<QDialog*>(top); dialog != nullptr && dialog->isVisible()) dialog->reject();
    for (Overlay* overlay : window_.findChildren<Overlay*>(Qt::FindDirectChildrenOnly))
        if (overlay != pad_) overlay->leave();
}

void Kiosk::askOperator(const QString& why, std::function<void()> run) {
    if (!closed_ || !pin_.isSet()) return run();
    if (padOpen()) return;
    pad_ = askPin(window_, pin_, why, std::move(run));
}

/// What Resume then asks, or wants to be held for, is the operator's to answer.
void Kiosk::letResume() {
    trustUntil_ = clock_.now() + kTrust;
    if (auto* button = qobject_cast<QAbstractButton*>(buttons_.resume)) button->click();
}

void Kiosk::knock(QWidget& door) {
    if (&door == buttons_.leave)
        askOperator("To leave the kiosk.", [this] { emit leaveWanted(); });
    else
        askOperator("To let the servos move again.", [this] { letResume(); });
}

bool Kiosk::mayHave(const QObject& watched) const {
    if (belongsTo(&watched, buttons_.stop) || (pad_ && belongsTo(&watched, pad_))) return true;
    return std::ranges::any_of(trusted_, [&](const auto& one) { return one && belongsTo(&watched, one); });
}

bool Kiosk::eventFilter(QObject* watched, QEvent* event) {
    const auto type = event->type();
    if (type == QEvent::Show && clock_.now() < trustUntil_ && qobject_cast<QDialog*>(watched) != nullptr)
        trusted_.emplace_back(static_cast<QWidget*>(watched));
    // A desktop's keys would bring the window out of full screen.
    if (type == QEvent::WindowStateChange && watched == &window_ && !window_.isFullScreen())
        QTimer::singleShot(0, this, [this] {
            if (closed_) window_.showFullScreen();
        });
    if (!isInput(type) || isEscape(*event)) return false;
    // A window hands its input on to its widgets, and there it is judged.
    if (watched->inherits("QWidgetWindow")) return false;
    if (mayHave(*watched) || (visitorsMayHave_ && visitorsMayHave_(*watched, *event))) return false;
    for (QWidget* door : {buttons_.resume, buttons_.leave}) {
        if (door == nullptr || watched != door) continue;
        if (type == QEvent::TouchBegin || type == QEvent::TouchUpdate || type == QEvent::TouchEnd)
            return false; // becomes a click
        if (type == QEvent::MouseButtonPress) pressed_ = door;
        if (type == QEvent::MouseButtonRelease && std::exchange(pressed_, nullptr) == door &&
            door->rect().contains(static_cast<QMouseEvent*>(event)->position().toPoint()))
            QTimer::singleShot(0, this, [this, door] {
                if (closed_) knock(*door);
            });
    }
    event->setAccepted(type != QEvent::DragEnter && type != QEvent::DragMove && type != QEvent::Drop);
    return true;
}

} // namespace lumorph::studio
