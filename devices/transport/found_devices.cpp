#include "devices/transport/found_devices.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include <QUrl>

#include "devices/transport/port_access.h"

namespace lumorph {

namespace {

namespace fs = std::filesystem;

constexpr std::uint16_t kLobotVendor = 0x0483;
constexpr std::uint16_t kLobotProduct = 0x5750;

struct KnownVendor {
    std::uint16_t vendor;
    const char* name;
    const char* hint;
    int baud;
};

constexpr std::array kKnownVendors{
    KnownVendor{0x2341, "Arduino", "an Arduino board; it needs Lumorph's sketch or StandardFirmata", 57600},
    KnownVendor{0x1a86, "CH340 serial adapter", "probably an Arduino Nano or a clone of an Uno", 57600},
    KnownVendor{0x0403, "FTDI serial adapter", "probably an Arduino Pro Mini, or an older Nano", 57600},
    KnownVendor{0x10c4, "CP210x serial adapter", "probably an Arduino Pro Mini, or an ESP board", 57600},
    KnownVendor{0x1ffb, "Pololu", "a Maestro has two ports; the first one takes commands", 115200},
};

const KnownVendor* knownVendor(std::uint16_t vendor) {
    const auto known = std::ranges::find(kKnownVendors, vendor, &KnownVendor::vendor);
    return known == kKnownVendors.end() ? nullptr : &*known;
}

std::string serialAddress(const std::string& path, int baud) {
    const QByteArray encoded = QUrl::toPercentEncoding(QString::fromStdString(path), "/");
    return "serial://" + encoded.toStdString() + "?baud=" + std::to_string(baud);
}

std::string fileName(const std::string& path) { return fs::path(path).filename().string(); }

/// Looks and does not open; a port that is in use is found out from the processes' open files.
LinkTrouble troubleAt(const std::string& path) {
    if (std::optional<LinkTrouble> trouble = accessTrouble(path)) return *trouble;
    return holderOf(path) ? inUse(path) : LinkTrouble{};
}

std::vector<std::string> boundPorts() {
    std::vector<std::string> paths;
    std::error_code none;
    for (fs::directory_iterator entry("/dev", none), end; !none && entry != end; entry.increment(none))
        if (entry->path().filename().string().starts_with("rfcomm")) paths.push_back(entry->path().string());
    std::ranges::sort(paths);
    return paths;
}

} // namespace

FoundDevice describeSerialPort(const SerialPort& port) {
    const KnownVendor* known = knownVendor(port.vendor);
    std::string name = port.description;
    if (name.empty()) name = known ? known->name : "serial port";
    return {serialAddress(port.path, known ? known->baud : 57600), name + " on " + fileName(port.path),
            known ? known->hint : "", port.serialNumber, troubleAt(port.path)};
}

FoundDevice describeBoundPort(const std::string& path) {
    return {serialAddress(path, 9600),
            "Bluetooth serial port " + fileName(path),
            "bound to a Bluetooth device; an HC-06 usually talks at 9600 baud",
            {},
            troubleAt(path)};
}

FoundDevice describeHidDevice(const HidDevice& device) {
    char address[32];
    std::snprintf(address, sizeof address, "hid://%04x:%04x", device.vendor, device.product);
    FoundDevice found{address, {}, {}, device.serialNumber, {}};
    if (!device.productText.empty())
        found.address +=
            "?product=" + QUrl::toPercentEncoding(QString::fromStdString(device.productText)).toStdString();
    found.name = (device.productText.empty() ? "USB device" : device.productText) + " on " + fileName(device.path);
    // Its ids alone do not tell: unrelated devices have the same.
    const bool isLobot = device.productText.find("LOBOT") != std::string::npos;
    found.hint = isLobot ? "a LewanSoul or Hiwonder servo controller" : "may be a servo controller, or something else";
    if (const std::optional<LinkTrouble> trouble = accessTrouble(device.path))
        found.trouble = permissionDenied(device.path) == *trouble ? hidPermissionDenied(device.path) : *trouble;
    else if (holderOf(device.path))
        found.trouble = inUse(device.path);
    return found;
}

std::vector<FoundDevice> findRealDevices() {
    std::vector<FoundDevice> found;
    for (const SerialPort& port : serialPorts())
        if (!fileName(port.path).starts_with("rfcomm")) found.push_back(describeSerialPort(port));
    for (const std::string& path : boundPorts()) found.push_back(describeBoundPort(path));
    for (const HidDevice& device : hidDevices(kLobotVendor, kLobotProduct)) found.push_back(describeHidDevice(device));
    return found;
}

} // namespace lumorph
