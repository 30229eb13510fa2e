#pragma once

#include <cstdint>
#include <string>

namespace lumorph {

/// The program that listens on a UDP port of this machine, such as "opentrack (process 1234)"; empty where the system
/// does not tell, as for programs of other users.
[[nodiscard]] std::string programAtUdpPort(std::uint16_t port);

} // namespace lumorph
