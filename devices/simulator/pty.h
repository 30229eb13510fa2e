#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace lumorph {

/// A pseudo-terminal: programs open `path` as a serial port, and its far end is in the owner's hand.
class Pty {
public:
    /// Throws DeviceError where the system has none left.
    Pty();
    ~Pty() { unplug(); }
    Pty(const Pty&) = delete;
    Pty& operator=(const Pty&) = delete;

    [[nodiscard]] const std::string& path() const { return path_; }
    void unplug(); ///< the far end is gone
    /// Throws DeviceError where nobody reads and it is full.
    void send(const std::vector<std::uint8_t>& bytes) const;
    [[nodiscard]] std::vector<std::uint8_t> receive() const; ///< what is there; does not wait
    void waitForBytes(std::chrono::milliseconds atMost) const;

private:
    int master_ = -1;
    std::string path_;
};

} // namespace lumorph
