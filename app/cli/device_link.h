#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <thread>

#include "app/cli/session.h"
#include "devices/controllers/servo_link.h"
#include "devices/simulator/simulated_bench.h"

namespace lumorph::cli {

/// A link for the time of a command; what it tells goes to stderr as it comes. However the command ends, by an error, a
/// signal, a second one or a reader that has gone, servos are let go first.
class DeviceLink {
public:
    using OnWire = std::function<void(std::span<const std::uint8_t>, bool)>;

    /// Opens it. Throws DeviceError with what is wrong: at once where waiting does not help (no such port, no
    /// permission, in use), after 8 seconds where the device may still come into reach of the radio.
    DeviceLink(const DeviceProfile& profile, Session& session, OnWire onWire = {});
    ~DeviceLink();
    DeviceLink(const DeviceLink&) = delete;
    DeviceLink& operator=(const DeviceLink&) = delete;

    ServoLink* operator->() noexcept { return &link_; }

    /// Waits until a condition on the status holds; false when the time is over, which 0 never is.
    template <class Condition> bool until(Condition condition, std::chrono::steady_clock::duration limit) {
        const auto end = std::chrono::steady_clock::now() + limit;
        while (!condition(link_.status())) {
            if (limit > limit.zero() && std::chrono::steady_clock::now() > end) return false;
            wait();
            tell();
        }
        tell();
        return true;
    }
    /// Until it has answered; where it is not certain what it is and `confirmed`, it is taken for what it seems to be.
    /// Throws DeviceError.
    void untilReady(bool confirmed);
    /// DeviceError with what the link says is wrong.
    [[noreturn]] void throwTrouble();

private:
    [[nodiscard]] LinkOptions options(OnWire onWire);
    void untilOpen();
    void letGo();
    void wait();
    void tell();

    Session& session_;
    SimulatedBench bench_;
    ServoLink link_;
};

} // namespace lumorph::cli
