#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "devices/controllers/device_profile.h"
#include "devices/transport/link_trouble.h"

namespace lumorph {

/// What a ServoEngine is told, one thing at a time.
namespace servo_input {
// By its user.
struct Connect {};
struct Disconnect {};
struct Confirm {}; ///< the board is what it seems to be
struct Arm {
    bool jumpAllowed = false;
};
struct Disarm {};
struct Stop {};
struct Command {
    std::vector<double> strokes; ///< for all servos
};
struct Wiggle {
    std::uint64_t servo = 0;
};
struct Slow {
    bool on = false;
};
struct Profile {
    DeviceProfile profile;
};
struct Quit {}; ///< to rest, detach, close

// By its link.
struct Opened {
    std::string product;
    std::string identity;
};
struct Received {
    std::vector<std::uint8_t> bytes;
};
struct Lost { ///< also when it could not be opened
    LinkTrouble why;
};
struct Released {}; ///< the failsafe process heard no beat of this program, and has let the servos go

/// Time passes.
struct Tick {
    std::uint64_t unsent = 0; ///< bytes that were written and have not left
};
} // namespace servo_input

using ServoInput = std::variant<servo_input::Connect, servo_input::Disconnect, servo_input::Confirm, servo_input::Arm,
                                servo_input::Disarm, servo_input::Stop, servo_input::Command, servo_input::Wiggle,
                                servo_input::Slow, servo_input::Profile, servo_input::Quit, servo_input::Opened,
                                servo_input::Received, servo_input::Lost, servo_input::Released, servo_input::Tick>;

} // namespace lumorph
