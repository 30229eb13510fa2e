#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "devices/controllers/device_profile.h"
#include "devices/controllers/servo_controller.h"

namespace lumorph {

/// A setting that one kind of controller has, and the others do not. Each has a member of its own in DeviceProfile.
struct ControllerOption {
    std::string_view key;   ///< in profiles
    std::string_view title; ///< for the user, as the next
    std::string_view tip;
    std::variant<int DeviceProfile::*, bool DeviceProfile::*> member;
    ProfileLimits limits; ///< of a number
};

/// All that the rest of the program knows of a kind of controller.
struct KnownController {
    ControllerKind kind = ControllerKind::firmata;
    std::string_view key;                ///< in profiles and arguments: "maestro"
    std::string_view title;              ///< for the user
    std::vector<std::string_view> words; ///< in lower case; they stand in addresses and names of such devices
    int firstChannel = 0;                ///< where the board begins to count
    int lastChannel = 0;                 ///< the greatest number that it can be told
    std::vector<ControllerOption> options;
    std::vector<std::string_view> simulators; ///< of the bench, that speak its language
    std::unique_ptr<ServoController> (*make)(const DeviceProfile& profile, const DeviceAddress& address) = nullptr;
};

/// The table of them, in the order in which they are offered. The first is what a port that tells nothing usually has.
[[nodiscard]] std::span<const KnownController> knownControllers();
/// Throws InvalidInput where there is none.
[[nodiscard]] const KnownController& knownController(ControllerKind kind);
/// Throws InvalidInput that names all keys where none is this.
[[nodiscard]] const KnownController& knownController(std::string_view key);
/// "firmata, lewansoul or maestro"
[[nodiscard]] std::string controllerKeys();

/// The kind of controller that an address or a device's name most likely stands for: the longest word in it decides.
[[nodiscard]] ControllerKind likelyController(std::string_view words);

/// Where a kind of controller begins to count its channels.
[[nodiscard]] int firstChannel(ControllerKind controller);

/// Whether both profiles tell the same of what single kinds of controllers have to be told.
[[nodiscard]] bool sameOptions(const DeviceProfile& a, const DeviceProfile& b);

} // namespace lumorph
