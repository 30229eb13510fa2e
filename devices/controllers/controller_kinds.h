#pragma once

#include <string_view>

#include "devices/controllers/device_profile.h"

namespace lumorph {

/// The kind of controller that an address or a device's name most likely stands for.
[[nodiscard]] ControllerKind likelyController(std::string_view words);

/// Where a kind of controller begins to count its channels.
[[nodiscard]] int firstChannel(ControllerKind controller);

/// Rigs count their drives from 0; boards from where their own numbers begin. Shifts all channels, so that the least is
/// `first`.
void countChannelsFrom(DeviceProfile& profile, int first);

} // namespace lumorph
