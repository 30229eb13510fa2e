#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tests/devices/pty.h"
#include "tests/firmware/board.h"

namespace lumorph::firmware_test {

/// A board on a pseudo-terminal, in a thread that keeps it to real time; on a busy machine it falls behind, and its own
/// clock with it.
class LiveBoard {
public:
    LiveBoard();
    ~LiveBoard();

    [[nodiscard]] const std::string& path() const { return pty_.path(); }
    void cutTheLine() { cut_ = true; }
    [[nodiscard]] std::vector<Pulse> pulses() const; ///< all until now
    /// Width of the newest pulse on a pin, if it is no older than two frames; 0: no pulse.
    [[nodiscard]] double widthNow(int pin) const;
    [[nodiscard]] double now() const;

private:
    void live();

    Pty pty_;
    mutable std::mutex mutex_;
    std::vector<Pulse> pulses_;
    double now_ = 0.0;
    std::atomic<bool> cut_{false};
    std::atomic<bool> ends_{false};
    std::thread thread_;
};

} // namespace lumorph::firmware_test
