#include "app/studio/shell/sight_watch.h"

#include <array>
#include <cstdlib>
#include <utility>

#include <QEvent>
#include <QGuiApplication>
#include <QPointer>
#include <QSocketNotifier>
#include <QWindow>

#include <xcb/xcb.h>

namespace lumorph::studio {
namespace {

struct EndConnection {
    void operator()(xcb_connection_t* connection) const { xcb_disconnect(connection); }
};
using XcbConnection = std::unique_ptr<xcb_connection_t, EndConnection>;

struct Free {
    void operator()(void* memory) const { std::free(memory); }
};

bool isX11() { return QGuiApplication::platformName() == QLatin1String("xcb"); }

} // namespace

struct SightWatch::Data {
    explicit Data(QWidget& watched) : window(watched) {}

    void listen(SightWatch& owner);
    void take(SightWatch& owner); ///< the window's handle, which may be another
    void select();
    void read();
    void tell(SightWatch& owner);
    [[nodiscard]] bool behindFullScreen() const;
    [[nodiscard]] bool isSeen() const;

    QWidget& window;
    QPointer<QWindow> handle;     ///< of the window, as far as it is watched
    QPointer<QWindow> lastActive; ///< of this program's windows
    bool exposed = true;          ///< until the desktop reports otherwise
    bool obscured = false;        ///< all of it, by other windows
    bool seen = true;
    // Qt does not ask for this event; a connection of its own may, and disturbs nothing.
    XcbConnection connection;
    std::unique_ptr<QSocketNotifier> notifier;
    xcb_window_t selected = XCB_WINDOW_NONE;
};

void SightWatch::Data::listen(SightWatch& owner) {
    QObject::connect(qGuiApp, &QGuiApplication::focusWindowChanged, &owner, [this, &owner](QWindow* active) {
        if (active == nullptr) return; // another program has the keyboard
        lastActive = active;
        tell(owner);
    });
    if (!isX11()) return;
    connection.reset(xcb_connect(nullptr, nullptr));
    if (xcb_connection_has_error(connection.get()) != 0) return connection.reset();
    notifier = std::make_unique<QSocketNotifier>(xcb_get_file_descriptor(connection.get()), QSocketNotifier::Read);
    QObject::connect(notifier.get(), &QSocketNotifier::activated, &owner, [this, &owner] {
        read();
        tell(owner);
    });
}

void SightWatch::Data::take(SightWatch& owner) {
    if (handle != window.windowHandle()) {
        handle = window.windowHandle();
        if (handle) handle->installEventFilter(&owner);
    }
    select();
}

/// The window gets another number when its flags change.
void SightWatch::Data::select() {
    if (!connection || !handle) return;
    const auto number = static_cast<xcb_window_t>(handle->winId());
    if (std::exchange(selected, number) == number) return;
    obscured = false;
    constexpr std::array<std::uint32_t, 1> kMask{XCB_EVENT_MASK_VISIBILITY_CHANGE};
    xcb_change_window_attributes(connection.get(), number, XCB_CW_EVENT_MASK, kMask.data());
    xcb_flush(connection.get());
}

void SightWatch::Data::read() {
    while (const auto event = std::unique_ptr<xcb_generic_event_t, Free>(xcb_poll_for_event(connection.get()))) {
        if ((event->response_type & 0x7FU) != XCB_VISIBILITY_NOTIFY) continue;
        const auto& now = reinterpret_cast<const xcb_visibility_notify_event_t&>(*event);
        if (now.window == selected) obscured = now.state == XCB_VISIBILITY_FULLY_OBSCURED;
    }
    if (xcb_connection_has_error(connection.get()) == 0) return;
    obscured = false;
    notifier->setEnabled(false); // the display is gone, and Qt ends the program
}

bool SightWatch::Data::behindFullScreen() const {
    if (!lastActive || !handle || lastActive == handle) return false;
    const Qt::WindowStates states = lastActive->windowStates();
    return lastActive->isExposed() && (states & Qt::WindowFullScreen) && !(states & Qt::WindowMinimized) &&
           lastActive->frameGeometry().contains(handle->frameGeometry());
}

bool SightWatch::Data::isSeen() const {
    return !window.isVisible() || (exposed && !window.isMinimized() && !obscured && !behindFullScreen());
}

void SightWatch::Data::tell(SightWatch& owner) {
    const bool now = isSeen();
    if (std::exchange(seen, now) != now) emit owner.changed();
}

SightWatch::SightWatch(QWidget& window) : QObject(&window), data_(std::make_unique<Data>(window)) {
    window.installEventFilter(this);
    data_->listen(*this);
    data_->take(*this);
}

SightWatch::~SightWatch() = default;

bool SightWatch::seen() const noexcept { return data_->seen; }

bool SightWatch::eventFilter(QObject* watched, QEvent* event) {
    switch (event->type()) {
    case QEvent::Expose:
        if (watched == data_->handle) data_->exposed = data_->handle->isExposed();
        break;
    case QEvent::Show:
    case QEvent::WinIdChange:
        if (watched == &data_->window) data_->take(*this);
        break;
    case QEvent::Hide:
    case QEvent::WindowStateChange:
        break;
    default:
        return false;
    }
    data_->tell(*this);
    return false;
}

} // namespace lumorph::studio
