#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/clock.h"
#include "devices/controllers/servo_controller.h"

/// What a user is told of a device with its servos.
namespace lumorph {

/// One servo as the live table shows it; strokes in [0, 1].
struct ServoStatus {
    double wanted = 0.0;
    double commanded = 0.0;         ///< by the guard
    std::optional<double> readBack; ///< where the controller can read it
    double microseconds = 0.0;      ///< pulse last sent
    bool attached = false;
    bool known = false; ///< somebody knows where it is
};

enum class LinkPhase {
    off,
    connecting,
    handshake,
    unidentified,
    disarmed,
    starting, ///< some servos are still to come: one by one, or once the user has said so (`LinkStatus::waiting`)
    live,
    stopped,
    lost
};

/// Whether a process of its own lets the servos go where this program cannot any more.
enum class LinkFailsafeState {
    none, ///< no link is open, or the board is a simulated one, which ends with the program
    runs,
    notShared, ///< this kind of link cannot be used by two processes
    missing    ///< it could not be started
};

struct LinkStatus {
    LinkPhase phase = LinkPhase::off;
    ControllerState controller;
    std::string product;
    std::string identity;
    std::optional<LinkTrouble> trouble;
    LinkFailsafeState failsafe = LinkFailsafeState::none;
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

} // namespace lumorph
