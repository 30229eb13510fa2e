#pragma once

#include <functional>
#include <memory>

#include <QString>

namespace lumorph::studio {

/// Esc twice within 600 ms, whichever program has the keyboard and even while the window is stuck: it listens to the
/// keyboard itself, over a connection to the X server of its own, in a thread of its own.
class StopKeyWatch {
public:
    /// `pressed` is called in that thread; it must return at once.
    explicit StopKeyWatch(std::function<void()> pressed);
    ~StopKeyWatch();

    /// Something is open that Esc closes: a second Esc waits a moment for `forget` before it counts, so that it works
    /// all the same while the window is stuck. Any thread.
    void setSomethingOpen(bool open);
    /// The presses until now were meant otherwise, or were answered. Any thread.
    void forget();

    /// Whether it can hear the keyboard. Where it cannot (Wayland, an old X server) `why` says so, and Esc Esc works in
    /// the program's own windows alone.
    [[nodiscard]] bool listens() const noexcept;
    [[nodiscard]] const QString& why() const noexcept;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::studio
