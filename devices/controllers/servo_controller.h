#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/clock.h"
#include "devices/controllers/device_profile.h"
#include "devices/controllers/guarded_pulses.h"
#include "devices/transport/address.h"
#include "devices/transport/link_trouble.h"

namespace lumorph {

/// What a kind of controller can do.
struct ControllerTraits {
    std::string name;           ///< "Firmata", "LewanSoul xArm", "Pololu Maestro"
    double pulseStep = 1.0;     ///< microseconds between two pulses it can tell apart
    bool readsPosition = false; ///< of the servos themselves, not what they were sent
    bool readsVoltage = false;
    double commandsPerSecond = 0; ///< that this link takes, of all servos together
    bool failsafe = false;        ///< it stops by itself when the studio dies
    std::string failsafeWord;     ///< for the user: what it does then, and when
    bool jumpsOnAttach = false;   ///< servos jump to the middle when they are attached (stock firmware)
};

/// How far it has come since the link was opened.
enum class ControllerPhase {
    handshake,    ///< questions were sent
    unidentified, ///< it answers, but what it is must be confirmed by the user before anything moves
    ready,
    refused ///< it is something else, or too old; `trouble` says so
};

struct ControllerState {
    ControllerPhase phase = ControllerPhase::handshake;
    ControllerTraits traits;
    std::string firmware; ///< "LumorphTablet 1.2", empty while unknown
    std::optional<double> volts;
    std::vector<std::optional<double>> readPulses; ///< by servo of the profile, microseconds; where it can be read
    std::uint64_t reboots = 0;                     ///< noticed in this session: handshake was begun anew
    std::uint64_t errors = 0;                      ///< broken frames, errors the device told
    bool answering = true;                         ///< false: it has been silent for a second
    bool detaching = false; ///< servos are told again and again to let go: nobody knows yet whether they have
    std::optional<LinkTrouble> trouble;
    bool batteryTrouble = false; ///< it is the battery's alone
};

/// What lets go of all servos of a board whatever it was told before, for a failsafe that knows no protocol.
struct ServoRelease {
    std::vector<std::vector<std::uint8_t>> messages; ///< whole ones; the first ends what was cut before it
    Microseconds gap{25'000};                        ///< between two times that they are written
    bool operator==(const ServoRelease&) const = default;
};

/// One kind of servo controller, as a machine that takes bytes and time and gives bytes: it does no I/O. What is sent
/// moves servos only through `send`.
class ServoController {
public:
    virtual ~ServoController() = default;
    /// The link has just been opened: what was known is void, and the handshake begins.
    virtual void opened(const std::string& product, Microseconds now) = 0;
    virtual void received(std::span<const std::uint8_t> bytes, Microseconds now) = 0;
    /// Time passes: handshakes are repeated, voltages asked for, heartbeats sent.
    virtual void tick(Microseconds now) = 0;
    /// Other limits, velocities or rate of the same servos on the same channels; all stay where they are, and a servo
    /// between whose limits it can make no pulse stays there.
    virtual void setLimits(const DeviceProfile& profile) = 0;
    /// The user says that it is what it seems to be.
    virtual void confirm() = 0;
    /// Writes what is different from what was sent last. Ignored unless ready, except that servos are detached in every
    /// phase.
    virtual void send(const GuardedPulses& pulses, Microseconds now) = 0;
    /// Servos that were told to be limp are told so once more, now: nobody knows whether it arrived.
    virtual void detachAgain() = 0;
    /// For a board that is ready. Nothing is written or remembered by asking.
    [[nodiscard]] virtual ServoRelease release() const = 0;
    /// Messages to write, in order; emptied by taking them.
    [[nodiscard]] virtual std::vector<std::vector<std::uint8_t>> takeOutput() = 0;
    [[nodiscard]] virtual const ControllerState& state() const = 0;
};

/// The controller of a profile on a link of this address (its baud rate limits the rate).
[[nodiscard]] std::unique_ptr<ServoController> makeController(const DeviceProfile& profile,
                                                              const DeviceAddress& address);

} // namespace lumorph
