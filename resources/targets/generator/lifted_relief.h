#pragma once

#include <array>

namespace lumorph {

/// How high the tablet's sheet is above its rest, in metres, at a place where its six levers (four corners, two long
/// edges, in the order of the rig's actuators) lift it by shares of their way. A smooth formula near to what the sheet
/// does: targets of it can be taken.
[[nodiscard]] double liftedHeight(const std::array<double, 6>& lifts, double x, double z);

} // namespace lumorph
