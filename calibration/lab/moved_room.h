#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/rig/rig.h"
#include "core/scene/installation.h"

namespace lumorph {

/// What is pushed aside in the virtual lab, and how far.
struct LabPush {
    std::string part;     ///< "projector", "camera", "device", or an actuator's name
    double metres = 0.0;  ///< root mean square over device and table, see `pushed`
    double degrees = 0.0; ///< of an actuator, in place of metres
};
/// Parses "projector:3mm", "camera:2.5mm", "device:4mm", "edge front:5deg" (an actuator of the rig). Throws
/// InvalidInput naming what is wrong.
[[nodiscard]] LabPush parseLabPush(std::string_view text, const Rig& rig);

/// The truth when somebody has pushed at a part: turned and shifted at random, as much as puts the projector's light
/// (or what the camera sees) that far beside on the table, root mean square over where the device lies; a device so far
/// that its body is (it stays on the table); of an actuator its true curve. The first projector and camera are meant.
/// The same for the same seed. Throws InvalidInput where the room has no such part.
[[nodiscard]] Installation pushed(Installation truth, const Rig& rig, const LabPush& push, std::uint32_t seed);

} // namespace lumorph
