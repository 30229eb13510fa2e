#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/clock.h"
#include "devices/controllers/device_profile.h"
#include "devices/controllers/servo_link_status.h"
#include "devices/controllers/servo_trace.h"

namespace lumorph {

class SimulatedBench;

struct LinkOptions {
    SimulatedBench* bench = nullptr;
    std::function<void()> onChange; ///< in the link's thread; must return at once
    std::function<void(std::span<const std::uint8_t>, bool)>
        onWire; ///< every message, true: sent; for monitor and recording
    /// What is started with each link to let servos go when this program cannot; empty: the one beside this program.
    std::filesystem::path failsafeProgram;
};

/// A device with its servos: transport, controller and guard in a thread of their own, and a hand for it. Everything
/// here may be called from any thread and returns at once. While the window's thread is stuck, servos go on to the last
/// command and stop() still works. Where this program ends without leave(), whatever ends it, or its link's thread is
/// stuck for a second, a process of its own lets the servos go (transport/link_failsafe.h), on links that two processes
/// can use. A QCoreApplication must be there.
class ServoLink {
public:
    /// Throws as checkProfile and parseDeviceAddress.
    ServoLink(DeviceProfile profile, LinkOptions options);
    /// As leave().
    ~ServoLink();
    /// Goes to rest (at most 2 s) where the profile says so and servos are live, detaches them, closes the link, and
    /// waits for all that; stop() cuts it short, setSlow() is heeded, and nothing else.
    void leave();

    void connect();
    void disconnect();
    void setProfile(DeviceProfile profile);
    [[nodiscard]] DeviceProfile profile() const;
    /// The user says that the board is what it seems to be.
    void confirmIdentity();

    void arm(bool jumpAllowed = false);
    void disarm();
    /// All servos are detached: the message is written within 50 ms, whatever else goes on.
    void stop();
    /// As stop(), and waits until the board should know: at most so long. False where it may not.
    bool letGo(std::chrono::milliseconds atMost);

    /// Strokes for all servos; the latest wins.
    void command(std::span<const double> strokes);
    void wiggle(std::size_t servo);
    void setSlow(bool slow);

    /// Hands every input and every byte sent to `sink`, in the link's thread, beginning with those since the link was
    /// made; an empty one ends it. Only so much is kept (about 64 MB, hours of a show): where a session has outgrown
    /// it, the first row says so. A sink must return at once, and may be called for a moment after it was ended.
    void setTrace(std::function<void(const ServoTraceRow&)> sink);

    [[nodiscard]] LinkStatus status() const;
    [[nodiscard]] std::vector<LinkEvent> takeEvents();

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph
