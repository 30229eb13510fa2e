#include "devices/transport/hid_devices.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <mutex>
#include <system_error>

#include <QString>
#include <hidapi/hidapi.h>

#include "devices/transport/port_access.h"

namespace lumorph {

namespace {

/// hidapi keeps its last error in one place for the whole program, so that threads must take turns here.
std::mutex& turn() {
    static std::mutex mutex;
    return mutex;
}

/// A device may call itself anything; what we show is one line.
std::string textOf(const wchar_t* text) {
    return text ? QString::fromWCharArray(text).simplified().toStdString() : std::string{};
}

std::string idsOf(const HidAddress& address) {
    char text[16];
    std::snprintf(text, sizeof text, "%04x:%04x", address.vendor, address.product);
    return text;
}

bool isMeant(const HidDevice& device, const HidAddress& address) {
    return device.vendor == address.vendor && device.product == address.product &&
           device.productText.find(address.productText) != std::string::npos;
}

} // namespace

std::vector<HidDevice> hidDevices(std::uint16_t vendor, std::uint16_t product) {
    const std::scoped_lock lock(turn());
    std::vector<HidDevice> devices;
    hid_device_info* const first = hid_enumerate(vendor, product);
    for (const hid_device_info* info = first; info; info = info->next) {
        // It is listed once for each of its usages.
        if (!info->path || std::ranges::find(devices, info->path, &HidDevice::path) != devices.end()) continue;
        devices.push_back(
            {info->path, info->vendor_id, info->product_id, textOf(info->serial_number), textOf(info->product_string)});
    }
    hid_free_enumeration(first);
    return devices;
}

std::variant<HidDevice, LinkTrouble> chooseHidDevice(const HidAddress& address, const std::string& serialNumber,
                                                     std::span<const HidDevice> devices) {
    std::vector<HidDevice> meant;
    const HidDevice* other = nullptr;
    for (const HidDevice& device : devices)
        if (isMeant(device, address) && (serialNumber.empty() || device.serialNumber == serialNumber))
            meant.push_back(device);
        else
            other = &device;
    if (meant.size() == 1) return meant.front();
    if (meant.size() > 1)
        return LinkTrouble{std::to_string(meant.size()) + " USB devices answer to " + idsOf(address),
                           "unplug all but the one that is to move"};
    if (other && !isMeant(*other, address))
        return LinkTrouble{"the USB device " + idsOf(address) + " calls itself \"" + other->productText + "\", not \"" +
                               address.productText + "\"",
                           "plug in the servo controller, or correct the product in the device's address"};
    return LinkTrouble{"there is no USB device " + idsOf(address),
                       "plug the servo controller in and switch its power on"};
}

LinkTrouble hidPermissionDenied(const std::string& path) {
    return {"permission denied on " + path,
            "install the rule 60-lumorph.rules (it comes with the Debian package; else: sudo cp "
            "packaging/udev/60-lumorph.rules /etc/udev/rules.d), then unplug the controller and plug it in again"};
}

std::variant<hid_device_*, LinkTrouble> openHidDevice(const std::string& path) {
    if (isHeldByAnother(path)) return inUse(path);
    const std::scoped_lock lock(turn());
    if (hid_device* const device = hid_open_path(path.c_str())) return device;
    const std::string why = textOf(hid_error(nullptr));
    // The number of the error is lost by now; its text is the system's, in the user's language.
    const auto says = [&](int error) { return why.find(std::generic_category().message(error)) != std::string::npos; };
    if (says(EACCES) || says(EPERM)) return hidPermissionDenied(path);
    if (says(EBUSY)) return inUse(path);
    return LinkTrouble{"the USB device at " + path + " cannot be opened (" + why + ")",
                       "unplug the controller and plug it in again"};
}

} // namespace lumorph
