#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <QCoreApplication>

namespace lumorph {

/// A pseudo-terminal whose far end is in the test's hand.
class Pty {
public:
    Pty();
    ~Pty() { unplug(); }
    Pty(const Pty&) = delete;
    Pty& operator=(const Pty&) = delete;

    [[nodiscard]] const std::string& path() const { return path_; }
    void unplug(); ///< the far end is gone
    void send(const std::vector<std::uint8_t>& bytes) const;
    [[nodiscard]] std::vector<std::uint8_t> receive() const; ///< what is there; does not wait
    void waitForBytes(std::chrono::milliseconds atMost) const;

private:
    int master_ = -1;
    std::string path_;
};

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

} // namespace lumorph
