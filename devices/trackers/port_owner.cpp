#include "devices/trackers/port_owner.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string_view>
#include <system_error>

namespace lumorph {

namespace {

namespace fs = std::filesystem;

/// As the links in /proc/PID/fd name them: "socket:[12345]".
std::set<std::string> socketsAt(std::uint16_t port) {
    std::set<std::string> sockets;
    for (const char* table : {"/proc/net/udp", "/proc/net/udp6"}) {
        std::ifstream file(table);
        std::string line;
        std::getline(file, line); // headings
        while (std::getline(file, line)) {
            std::istringstream words(line);
            std::string slot, local, remote, state, queues, timer, retransmits, user, timeout, inode;
            words >> slot >> local >> remote >> state >> queues >> timer >> retransmits >> user >> timeout >> inode;
            const std::string_view hex = std::string_view(local).substr(std::min(local.size(), local.rfind(':') + 1));
            unsigned number = 0;
            std::from_chars(hex.data(), hex.data() + hex.size(), number, 16);
            if (number == port && !inode.empty()) sockets.insert("socket:[" + inode + "]");
        }
    }
    return sockets;
}

bool holdsOne(const fs::path& process, const std::set<std::string>& sockets) {
    std::error_code error;
    for (fs::directory_iterator file(process / "fd", error), end; !error && file != end; file.increment(error)) {
        std::error_code gone;
        if (sockets.contains(fs::read_symlink(file->path(), gone).string())) return true;
    }
    return false;
}

} // namespace

std::string programAtUdpPort(std::uint16_t port) {
    const std::set<std::string> sockets = socketsAt(port);
    if (sockets.empty()) return {};
    std::error_code error;
    for (fs::directory_iterator entry("/proc", error), end; !error && entry != end; entry.increment(error)) {
        const std::string process = entry->path().filename().string();
        const bool isProcess = std::ranges::all_of(process, [](unsigned char c) { return std::isdigit(c) != 0; });
        if (!isProcess || !holdsOne(entry->path(), sockets)) continue;
        std::ifstream file(entry->path() / "comm");
        std::string name;
        std::getline(file, name);
        return (name.empty() ? "a program" : name) + " (process " + process + ")";
    }
    return {};
}

} // namespace lumorph
