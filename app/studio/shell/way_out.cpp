#include "app/studio/shell/way_out.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <thread>

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <QApplication>
#include <QThread>

namespace lumorph::studio {
namespace {

using WallClock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kStuckAfter{500};
constexpr milliseconds kLetGoWithin{1000};
constexpr std::array kAskToEnd{SIGINT, SIGTERM, SIGHUP, SIGQUIT};

/// A signal handler may touch nothing but this: it writes the signal's number, and a thread wakes up.
std::atomic<int> signalSocket = -1;

extern "C" void passSignal(int signal) {
    const int before = errno;
    const auto number = static_cast<unsigned char>(signal);
    [[maybe_unused]] const auto written = ::write(signalSocket, &number, 1);
    errno = before;
}

} // namespace

struct WayOut::Data {
    Data(MainWindow& itsWindow, Studio& itsStudio) : window(itsWindow), studio(itsStudio) {}

    void listen();
    void close();
    void endBy(int signal);
    void onExit();

    MainWindow& window;
    Studio& studio;
    std::array<int, 2> sockets{-1, -1};
    std::atomic<bool> closing = false;
    std::jthread thread;
};

namespace {

/// Of exit(), which takes no argument along; null once the program has ended by itself.
std::atomic<std::function<void()>*> atExit = nullptr;

void leaveAtExit() {
    if (const auto* leave = atExit.exchange(nullptr)) (*leave)();
}

} // namespace

/// In a thread of its own: a window that is stuck does not keep servos from being let go.
void WayOut::Data::listen() {
    bool asked = false;
    std::optional<WallClock::time_point> due;
    for (;;) {
        pollfd socket{sockets[1], POLLIN, 0};
        const auto left = due ? std::chrono::ceil<milliseconds>(*due - WallClock::now()).count() : -1;
        const int ready = ::poll(&socket, 1, due ? static_cast<int>(std::max<milliseconds::rep>(left, 0)) : -1);
        if (ready == 0) {
            due.reset();
            if (!closing) studio.devices.letGo(kLetGoWithin);
            continue;
        }
        unsigned char signal = 0;
        if (::read(sockets[1], &signal, 1) != 1) continue;
        if (signal == 0) return;
        if (!std::exchange(asked, true)) {
            due = WallClock::now() + kStuckAfter;
            QMetaObject::invokeMethod(
                &window, [this] { close(); }, Qt::QueuedConnection);
        } else if (signal != SIGHUP) {
            endBy(signal);
        }
    }
}

void WayOut::Data::close() {
    closing = true;
    studio.devices.beginLeave();
    window.closeNow();
}

void WayOut::Data::endBy(int signal) {
    studio.devices.letGo(kLetGoWithin);
    ::signal(signal, SIG_DFL);
    ::kill(::getpid(), signal);
    std::this_thread::sleep_for(kLetGoWithin);
    std::_Exit(1); // where somebody has blocked it
}

/// In whichever thread lost the display. The objects of the studio still live: exit() takes nothing off the stack.
void WayOut::Data::onExit() {
    const bool free = studio.devices.letGo(kLetGoWithin);
    std::fprintf(stderr, "lumorph-studio: display: it is gone, and the program ends%s\n",
                 free ? "" : "; servos may still have power: switch it off by hand");
    if (QThread::currentThread() == window.thread()) studio.project.keepSession();
    std::_Exit(1);
}

WayOut::WayOut(MainWindow& window, Studio& studio) : data_(std::make_unique<Data>(window, studio)) {
    // What the program says may have no reader any more; servos must not be left for that.
    ::signal(SIGPIPE, SIG_IGN);
    static std::function<void()> leave;
    leave = [data = data_.get()] { data->onExit(); };
    if (static const bool registered = std::atexit(leaveAtExit) == 0; registered) atExit = &leave;
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, data_->sockets.data()) != 0) return;
    data_->thread = std::jthread([data = data_.get()] { data->listen(); });
    signalSocket = data_->sockets[0];
    struct sigaction action {};
    action.sa_handler = passSignal;
    action.sa_flags = SA_RESTART;
    for (const int signal : kAskToEnd) ::sigaction(signal, &action, nullptr);
}

WayOut::~WayOut() {
    atExit = nullptr;
    if (data_->sockets[0] < 0) return;
    for (const int signal : kAskToEnd) ::signal(signal, SIG_DFL);
    const unsigned char end = 0;
    [[maybe_unused]] const auto written = ::write(data_->sockets[0], &end, 1);
    data_->thread.join();
    signalSocket = -1;
    for (const int socket : data_->sockets) ::close(socket);
}

int WayOut::exec() {
    const int status = QApplication::exec();
    data_->studio.devices.leave();
    return status;
}

} // namespace lumorph::studio
