#pragma once

#include <chrono>
#include <functional>
#include <memory>

#include <QCoreApplication>

namespace lumorph {

/// The program that a Qt event loop needs, where there is none yet.
class EventLoop {
public:
    EventLoop();
    /// Runs the event loop until `isDone`; false where that took longer than `limit`.
    static bool runUntil(const std::function<bool()>& isDone, std::chrono::milliseconds limit);
    static void runFor(std::chrono::milliseconds time);

private:
    int count_ = 1;
    char name_[5] = "test";
    char* names_[2] = {name_, nullptr};
    std::unique_ptr<QCoreApplication> application_;
};

/// Waits for it, without an event loop; false where it did not come within the limit.
[[nodiscard]] bool comesTrue(const std::function<bool()>& condition, std::chrono::milliseconds limit);

} // namespace lumorph
