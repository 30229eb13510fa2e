#include "devices/transport/serial_ports.h"

#include <algorithm>

#include <QSerialPortInfo>

#include "devices/transport/port_access.h"

namespace lumorph {

namespace {

bool looksAlike(const SerialPort& a, const SerialPort& b) {
    return a.vendor == b.vendor && a.product == b.product && a.serialNumber == b.serialNumber;
}

} // namespace

std::vector<SerialPort> serialPorts() {
    std::vector<SerialPort> ports;
    for (const QSerialPortInfo& info : QSerialPortInfo::availablePorts())
        ports.push_back({info.systemLocation().toStdString(), info.serialNumber().toStdString(),
                         info.vendorIdentifier(), info.productIdentifier(), info.description().toStdString()});
    std::ranges::sort(ports, {}, &SerialPort::path);
    return ports;
}

std::optional<SerialPort> serialPortAt(const std::string& path, std::span<const SerialPort> ports) {
    const auto port = std::ranges::find(ports, realPath(path), &SerialPort::path);
    if (port == ports.end()) return std::nullopt;
    return *port;
}

std::optional<std::string> portOf(const std::string& serialNumber, std::span<const SerialPort> ports) {
    const auto isMeant = [&](const SerialPort& port) { return port.serialNumber == serialNumber; };
    const auto port = std::ranges::find_if(ports, isMeant);
    if (port == ports.end() || std::ranges::count_if(ports, isMeant) > 1) return std::nullopt;
    return port->path;
}

void PortMemory::remember(const std::string& path, std::span<const SerialPort> ports) {
    forget();
    device_ = serialPortAt(path, ports);
    // A port that is soldered to the board has nothing but its name.
    if (device_ && device_->vendor == 0 && device_->serialNumber.empty()) device_.reset();
    if (!device_) return;
    for (const SerialPort& port : ports)
        if (looksAlike(port, *device_) && port.path != device_->path) others_.push_back(port.path);
}

void PortMemory::forget() {
    device_.reset();
    others_.clear();
}

std::optional<std::string> PortMemory::find(const std::string& typed, std::span<const SerialPort> ports) {
    if (!device_) return typed;
    // What went away and came back may be any of them.
    std::erase_if(others_, [&](const std::string& path) {
        return std::ranges::find(ports, path, &SerialPort::path) == ports.end();
    });
    std::vector<std::string> candidates;
    for (const SerialPort& port : ports)
        if (looksAlike(port, *device_) && std::ranges::find(others_, port.path) == others_.end())
            candidates.push_back(port.path);
    if (std::ranges::find(candidates, realPath(typed)) != candidates.end()) return typed;
    if (candidates.size() != 1) return std::nullopt;
    return candidates.front();
}

} // namespace lumorph
