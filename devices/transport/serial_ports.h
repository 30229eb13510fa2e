#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lumorph {

/// A serial port as the system lists it. Pseudo-terminals are not listed.
struct SerialPort {
    std::string path; ///< "/dev/ttyUSB0"
    std::string serialNumber;
    std::uint16_t vendor = 0; ///< of its USB device; 0 where it has none
    std::uint16_t product = 0;
    std::string description; ///< what it calls itself
    bool operator==(const SerialPort&) const = default;
};

[[nodiscard]] std::vector<SerialPort> serialPorts();
/// The port that `path` leads to.
[[nodiscard]] std::optional<SerialPort> serialPortAt(const std::string& path, std::span<const SerialPort> ports);

/// Where the only device with this serial number is.
[[nodiscard]] std::optional<std::string> portOf(const std::string& serialNumber, std::span<const SerialPort> ports);

/// Finds a device again whose port has another name: by its serial number or, without one, by VID:PID. Ports that were
/// there beside it are not it. A device that the system does not list (a pseudo-terminal) is known by its path.
class PortMemory {
public:
    /// The device is open at `path`.
    void remember(const std::string& path, std::span<const SerialPort> ports);
    void forget();
    /// find() would not look at the ports; listing them takes some milliseconds.
    [[nodiscard]] bool isEmpty() const { return !device_; }
    /// Where it is now: `typed` where nothing but its path is known; empty where it is not there, or where more than
    /// one port may be it.
    [[nodiscard]] std::optional<std::string> find(const std::string& typed, std::span<const SerialPort> ports);

private:
    std::optional<SerialPort> device_;
    std::vector<std::string> others_; ///< paths of ports that look like it and have been there ever since
};

} // namespace lumorph
