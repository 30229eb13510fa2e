#include "tests/devices/event_loop.h"

#include <thread>

#include <QEventLoop>
#include <unistd.h>

namespace lumorph {

EventLoop::EventLoop() {
    if (!QCoreApplication::instance()) application_ = std::make_unique<QCoreApplication>(count_, names_);
}

bool EventLoop::runUntil(const std::function<bool()>& isDone, std::chrono::milliseconds limit) {
    const auto end = std::chrono::steady_clock::now() + limit;
    QEventLoop loop;
    while (!isDone()) {
        if (std::chrono::steady_clock::now() > end) return false;
        ::usleep(1000);
        loop.processEvents();
    }
    return true;
}

void EventLoop::runFor(std::chrono::milliseconds time) {
    (void)runUntil([] { return false; }, time);
}

bool comesTrue(const std::function<bool()>& condition, std::chrono::milliseconds limit) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
}

} // namespace lumorph
