#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/clock.h"
#include "devices/controllers/servo_controller.h"
#include "devices/controllers/servo_guard.h"
#include "devices/controllers/servo_trace.h"

namespace lumorph {

class SimulatedBench;

/// One servo as the live table shows it; strokes in [0, 1].
struct ServoStatus {
    double wanted = 0.0;
    double commanded = 0.0;         ///< by the guard
    std::optional<double> readBack; ///< where the controller can read it
    double microseconds = 0.0;      ///< pulse last sent
    bool attached = false;
    bool known = false; ///< somebody knows where it is
};

enum class LinkPhase { off, connecting, handshake, unidentified, disarmed, starting, live, stopped, lost };

struct LinkStatus {
    LinkPhase phase = LinkPhase::off;
    ControllerState controller;
    std::string product;
    std::string identity;
    std::optional<LinkTrouble> trouble;
    std::vector<ServoStatus> servos;
    std::vector<std::size_t> waiting; ///< servos that need the user's word before they start
    double commandsPerSecond = 0.0;   ///< of the last second
    double latencyMilliseconds =
        0.0; ///< median of the last ones, from command() to the first byte's write, beyond the rate cap
    std::uint64_t bytesSent = 0;
    std::uint64_t reconnects = 0;
    std::uint64_t clamped = 0, refused = 0;
    bool slow = false;
};

/// Something its user should know of.
struct LinkEvent {
    enum class Kind { information, warning, failure };
    Microseconds time{0};
    Kind kind = Kind::information;
    std::string text;
    std::string remedy; ///< may be empty
    bool operator==(const LinkEvent&) const = default;
};

struct LinkOptions {
    SimulatedBench* bench = nullptr;
    std::function<void()> onChange; ///< in the link's thread; must return at once
    std::function<void(std::span<const std::uint8_t>, bool)>
        onWire; ///< every message, true: sent; for monitor and recording
};

/// A device with its servos: transport, controller and guard in a thread of their own, and a hand for it. Everything
/// here may be called from any thread and returns at once. While the window's thread is stuck, servos go on to the last
/// command and stop() still works. A QCoreApplication must be there.
class ServoLink {
public:
    /// Throws as checkProfile and parseDeviceAddress.
    ServoLink(DeviceProfile profile, LinkOptions options);
    /// Goes to rest (at most 2 s) where the profile says so and servos are live, detaches them and closes the link.
    ~ServoLink();

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

    /// Strokes for all servos; the latest wins.
    void command(std::span<const double> strokes);
    void wiggle(std::size_t servo);
    void setSlow(bool slow);

    /// Hands every input and every byte sent to `sink`, in the link's thread, beginning with those since the link was
    /// made as far as they were kept (the last row of a history that is not whole says so); an empty one ends it. It
    /// must return at once.
    void setTrace(std::function<void(const ServoTraceRow&)> sink);

    [[nodiscard]] LinkStatus status() const;
    [[nodiscard]] std::vector<LinkEvent> takeEvents();

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph
