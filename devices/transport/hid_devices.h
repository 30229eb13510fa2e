#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "devices/transport/address.h"
#include "devices/transport/link_trouble.h"

struct hid_device_;

namespace lumorph {

/// A HID device as the system lists it.
struct HidDevice {
    std::string path; ///< "/dev/hidraw0"
    std::uint16_t vendor = 0;
    std::uint16_t product = 0;
    std::string serialNumber;
    std::string productText;
    bool operator==(const HidDevice&) const = default;
};

/// All with these ids, each once. Any thread.
[[nodiscard]] std::vector<HidDevice> hidDevices(std::uint16_t vendor, std::uint16_t product);

/// The one that is meant. Where `serialNumber` is not empty, it is that one and no other. More than one is trouble: a
/// wrong guess moves somebody else's servos.
[[nodiscard]] std::variant<HidDevice, LinkTrouble>
chooseHidDevice(const HidAddress& address, const std::string& serialNumber, std::span<const HidDevice> devices);

/// Opens it; whoever calls closes it by hid_close. Any thread.
[[nodiscard]] std::variant<hid_device_*, LinkTrouble> openHidDevice(const std::string& path);

[[nodiscard]] LinkTrouble hidPermissionDenied(const std::string& path);

} // namespace lumorph
