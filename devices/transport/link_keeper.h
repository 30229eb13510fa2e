#pragma once

#include <memory>
#include <optional>

#include "core/base/clock.h"
#include "devices/transport/link_world.h"
#include "devices/transport/transport.h"

namespace lumorph {

/// Keeps a link open: reopens it with growing pauses (0.2 s, doubling, at most 2 s; at once where the device has just
/// come back), and finds a device again whose port has another name by its serial number or, without one, by VID:PID. A
/// dead link floods errors: it is closed at the first. Lives in the transport's thread. Its events may call all of it,
/// but not destroy it.
class LinkKeeper {
public:
    struct Events {
        std::function<void()> opened; ///< all that was known of the device may have changed
        std::function<void(std::span<const std::uint8_t>)> received;
        /// An open link is gone, or an attempt failed for another reason than the one before: once for each new
        /// trouble, not for each attempt. What makeTransport refuses is told here too.
        std::function<void(const LinkTrouble&)> lost;
    };
    LinkKeeper(DeviceAddress address, Events events, SimulatedBench* bench);
    LinkKeeper(DeviceAddress address, Events events, LinkWorld world);
    ~LinkKeeper();

    /// `identity`: the serial number of the device that is meant. Where a port that calls itself so is found, it is
    /// opened, under whatever name. Empty: the address alone counts.
    void start(Microseconds now, std::string identity = {});
    void stop();
    /// Does what is due; call it every 50 ms or more often.
    void tick(Microseconds now);
    /// The device does not answer: closes the link and begins anew. `why` is told as any other trouble.
    void drop(const LinkTrouble& why, Microseconds now);
    void write(std::span<const std::uint8_t> message);
    /// As Transport::dropUnsent.
    void dropUnsent();

    [[nodiscard]] bool isOpen() const;
    [[nodiscard]] std::size_t unsent() const;
    [[nodiscard]] std::string identity() const;
    [[nodiscard]] std::string product() const;
    [[nodiscard]] SharedLink shared() const;                  ///< as Transport::shared
    [[nodiscard]] std::optional<LinkTrouble> trouble() const; ///< empty while open

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph
