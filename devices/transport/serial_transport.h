#pragma once

#include <memory>

#include "devices/transport/transport.h"

namespace lumorph {

/// A serial port, a bound rfcomm port or a pseudo-terminal, at any path. Eight data bits, no parity, one stop bit, no
/// flow control. It has the port for itself. A wrong baud rate goes unnoticed here: the bytes are only nonsense.
[[nodiscard]] std::unique_ptr<Transport> makeSerialTransport(SerialAddress address, Transport::Events events);

} // namespace lumorph
