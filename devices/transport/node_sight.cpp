#include <sys/stat.h>

#include <variant>

#include "devices/transport/link_world.h"

namespace lumorph {

namespace {

std::string digits(const timespec& time) { return std::to_string(time.tv_sec) + '.' + std::to_string(time.tv_nsec); }

} // namespace

std::string sightOfNode(const DeviceAddress& address) {
    if (std::holds_alternative<BluetoothAddress>(address)) return {}; // the air tells nothing
    std::string sight;
    struct stat node {};
    if (::stat("/dev", &node) == 0) sight = digits(node.st_mtim);
    const auto* serial = std::get_if<SerialAddress>(&address);
    // The time of its change tells that its permissions were set: that comes a moment after the node.
    if (serial && ::stat(serial->path.c_str(), &node) == 0)
        sight += ' ' + std::to_string(node.st_ino) + ' ' + std::to_string(node.st_rdev) + ' ' + digits(node.st_ctim);
    return sight;
}

} // namespace lumorph
