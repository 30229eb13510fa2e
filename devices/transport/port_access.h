#pragma once

#include <optional>
#include <string>

#include "devices/transport/link_trouble.h"

namespace lumorph {

/// Why this user cannot open the device node at `path` (not there, no device, permission), without opening it; empty
/// where nothing speaks against it.
[[nodiscard]] std::optional<LinkTrouble> accessTrouble(const std::string& path);

[[nodiscard]] LinkTrouble notThere(const std::string& path);
[[nodiscard]] LinkTrouble permissionDenied(const std::string& path);
/// Names the program that has the device, where the system tells it.
[[nodiscard]] LinkTrouble inUse(const std::string& path);

/// A program that has a device node open.
struct PortHolder {
    int process = 0;
    std::string program;
};

/// Somebody else before this program itself; empty where nobody has it open, or nobody that this user may see.
[[nodiscard]] std::optional<PortHolder> holderOf(const std::string& path);

/// Somebody else has it; pseudo-terminals are always open at their far end and do not count.
[[nodiscard]] bool isHeldByAnother(const std::string& path);

/// The path with all links followed; as it is where there is nothing.
[[nodiscard]] std::string realPath(const std::string& path);

} // namespace lumorph
