#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "devices/simulator/pty.h"
#include "tests/core/temporary_folder.h"
#include "tests/firmware/board.h"

namespace lumorph::firmware_test {

/// A board on a pseudo-terminal, in a thread that keeps it to real time; on a busy machine it falls behind, and its own
/// clock with it.
class LiveBoard {
public:
    LiveBoard();
    ~LiveBoard();

    /// A link to the pseudo-terminal there is now; it stays the same when the line is cut and mended.
    [[nodiscard]] const std::string& path() const { return path_; }
    void cutTheLine() { plugged_ = false; }
    void mendTheLine() { plugged_ = true; }
    [[nodiscard]] std::vector<Pulse> pulses() const; ///< all until now
    /// Width of the newest pulse on a pin, if it is no older than two frames; 0: no pulse.
    [[nodiscard]] double widthNow(int pin) const;
    [[nodiscard]] double now() const;

private:
    void live();
    void plug();

    TemporaryFolder folder_;
    std::string path_;
    std::unique_ptr<Pty> pty_; ///< of the board's thread
    mutable std::mutex mutex_;
    std::vector<Pulse> pulses_;
    double now_ = 0.0;
    std::atomic<bool> plugged_{true};
    std::atomic<bool> ends_{false};
    std::thread thread_;
};

} // namespace lumorph::firmware_test
