#pragma once

#include <memory>

#include "devices/transport/transport.h"

namespace lumorph {

/// A USB-HID device with unnumbered 64-byte reports. Once it was open, it is opened again only with the same serial
/// number. A write to a stuck device takes seconds in the system; it does not hold up the caller.
[[nodiscard]] std::unique_ptr<Transport> makeHidTransport(HidAddress address, Transport::Events events);

} // namespace lumorph
