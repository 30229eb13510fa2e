#pragma once

#include <string>

namespace lumorph {

/// Why a link is not there, and what its user can do about it.
struct LinkTrouble {
    std::string why;    ///< "permission denied on /dev/ttyUSB0"
    std::string remedy; ///< "add yourself to the group dialout and log in again"
    bool operator==(const LinkTrouble&) const = default;
};

} // namespace lumorph
