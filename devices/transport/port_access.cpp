#include "devices/transport/port_access.h"

#include <cerrno>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <fcntl.h>
#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

#include "devices/transport/failsafe_messages.h"

namespace lumorph {

namespace {

namespace fs = std::filesystem;

constexpr int kMostLinks = 50'000; // of open files looked at; a busy server has more than a search may cost

/// The group that may open it; Debian's for serial ports where the node does not tell.
std::string groupOf(const std::string& path) {
    struct stat node {};
    if (::stat(path.c_str(), &node) != 0 || node.st_gid == 0 || !(node.st_mode & S_IWGRP)) return "dialout";
    group entry{};
    group* found = nullptr;
    char names[4096];
    if (::getgrgid_r(node.st_gid, &entry, names, sizeof names, &found) != 0 || !found) return "dialout";
    return found->gr_name;
}

std::string programOf(const fs::path& process) {
    std::ifstream file(process / "comm");
    std::string name;
    std::getline(file, name);
    return name.empty() ? "another program" : name;
}

/// True where one of the open files of a process is `path`. Processes of other users show none.
bool hasOpen(const fs::path& process, const std::string& path, int& links) {
    std::error_code unreadable;
    for (fs::directory_iterator file(process / "fd", unreadable), end; !unreadable && file != end;
         file.increment(unreadable)) {
        if (--links < 0) return false;
        std::error_code closed;
        if (fs::read_symlink(file->path(), closed) == path) return true;
    }
    return false;
}

std::optional<int> processNumber(const fs::path& folder) {
    const std::string name = folder.filename().string();
    int number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error != std::errc{} || end != name.data() + name.size()) return std::nullopt;
    return number;
}

} // namespace

std::string realPath(const std::string& path) {
    std::error_code nothing;
    const fs::path real = fs::canonical(path, nothing);
    return nothing ? path : real.string();
}

LinkTrouble notThere(const std::string& path) {
    return {"there is no port " + path, "plug the device in, or choose another port"};
}

LinkTrouble permissionDenied(const std::string& path) {
    return {"permission denied on " + path, "add yourself to the group " + groupOf(path) + " (sudo usermod -aG " +
                                                groupOf(path) + " $USER), then log out and log in again"};
}

LinkTrouble inUse(const std::string& path) {
    const std::optional<PortHolder> holder = holderOf(path);
    if (!holder)
        return {"another program uses " + path,
                "close the program that uses it (a serial monitor, the Arduino IDE, ModemManager)"};
    if (holder->program == failsafe::kShortName)
        return {"the servos at " + path + " are being let go, after a Lumorph that ended or hangs",
                "wait a moment; where it lasts, end the other Lumorph"};
    if (holder->process == ::getpid())
        return {"this program uses " + path + " already", "disconnect the device that uses it first"};
    return {"the program " + holder->program + " uses " + path, "close " + holder->program};
}

std::optional<LinkTrouble> accessTrouble(const std::string& path) {
    struct stat node {};
    if (::stat(path.c_str(), &node) != 0) return errno == EACCES ? permissionDenied(path) : notThere(path);
    if (!S_ISCHR(node.st_mode)) return LinkTrouble{path + " is not a device", "choose the port of the device"};
    // The rights of the effective user count when it is opened, not those of the real one.
    if (::faccessat(AT_FDCWD, path.c_str(), R_OK | W_OK, AT_EACCESS) != 0) return permissionDenied(path);
    return std::nullopt;
}

std::optional<PortHolder> holderOf(const std::string& path) {
    const std::string real = realPath(path);
    std::optional<PortHolder> found;
    int links = kMostLinks;
    std::error_code unreadable;
    for (fs::directory_iterator process("/proc", unreadable), end; !unreadable && process != end;
         process.increment(unreadable)) {
        const std::optional<int> number = processNumber(process->path());
        if (!number || !hasOpen(process->path(), real, links)) continue;
        const PortHolder holder{*number, programOf(process->path())};
        // The failsafe process of a link is there for whoever has the link.
        const bool isFailsafe = holder.program == failsafe::kShortName;
        if (!found || !isFailsafe) found = holder;
        if (*number != ::getpid() && !isFailsafe) break;
    }
    return found;
}

bool isHeldByAnother(const std::string& path) {
    if (realPath(path).starts_with("/dev/pts/")) return false;
    const std::optional<PortHolder> holder = holderOf(path);
    return holder && holder->process != ::getpid();
}

} // namespace lumorph
