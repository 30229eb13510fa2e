#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "devices/transport/address.h"
#include "devices/transport/link_trouble.h"

namespace lumorph {

class SimulatedBench;

/// What another process needs to write to the same device when this program cannot any more.
struct SharedLink {
    int descriptor = -1;    ///< of the system; -1: the link cannot be shared
    std::size_t report = 0; ///< bytes of a HID report, without its number; 0: a stream of bytes
};

/// A way for bytes to one device and back. It knows no messages. Lives in one thread that runs a Qt event loop; nothing
/// of it blocks. Only ServoLink may hold one: what reaches a servo has passed the ServoGuard (packaging/check sees to
/// it).
class Transport {
public:
    struct Events {
        std::function<void()> opened;
        std::function<void(std::span<const std::uint8_t>)> received; ///< of a HID device: one report
        std::function<void(const LinkTrouble&)> closed; ///< once for each open() that failed or ended by itself
    };

    virtual ~Transport() = default;
    /// Answers by `opened` or `closed`, maybe before it returns. While it is open or opening: nothing.
    virtual void open() = 0;
    /// At once; `closed` is not called. What was not sent is dropped.
    virtual void close() = 0;
    [[nodiscard]] virtual bool isOpen() const = 0;
    /// A whole message; on HID one report, filled up with zeros. Without an open link it is dropped.
    virtual void write(std::span<const std::uint8_t> message) = 0;
    /// What was written and has not begun to leave is dropped, as whole messages, where the link can tell: what is
    /// written next goes out first.
    virtual void dropUnsent() {}
    /// Bytes that were written but have not left this program: more than a few mean that the link stalls.
    [[nodiscard]] virtual std::size_t unsent() const = 0;
    /// What tells this device from all others, as far as it is known (serial number, MAC); empty else.
    [[nodiscard]] virtual std::string identity() const = 0;
    /// What the device calls itself (USB product text), for the user's eyes and for checks; may be empty.
    [[nodiscard]] virtual std::string product() const = 0;
    /// While it is open; the descriptor is closed with the link, whoever has a copy.
    [[nodiscard]] virtual SharedLink shared() const { return {}; }
};

/// `bench` holds the simulated boards; `sim://` addresses without one are in trouble at open(). Throws InvalidInput for
/// a simulated board that the bench does not have.
[[nodiscard]] std::unique_ptr<Transport> makeTransport(const DeviceAddress& address, Transport::Events events,
                                                       SimulatedBench* bench);

} // namespace lumorph
