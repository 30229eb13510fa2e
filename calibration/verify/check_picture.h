#pragma once

#include <cstddef>
#include <span>

#include "calibration/verify/room_check.h"
#include "core/base/image.h"
#include "core/rig/rig.h"
#include "core/scene/installation.h"

namespace lumorph {

/// An error map from above: the device on its table, and an arrow from where light was meant to be to where it is, made
/// eight times as long and coloured from green (none) to red (3 mm and more). `strokes`: the bend that is drawn.
[[nodiscard]] Image errorPicture(const RoomCheck& check, const Rig& rig, const Installation& believed,
                                 std::span<const double> strokes, int width = 1200);

/// What a projector shows to check by eye: lines each centimetre on the device, which bend with it, and crosshairs each
/// five; on the table lines each five centimetres. Where the room is as it is believed to be they lie on the same
/// places of the device whatever its bend. Throws InvalidInput for a projector that the room does not have.
[[nodiscard]] Image gridPicture(const Rig& rig, const Installation& believed, std::span<const double> strokes,
                                std::size_t projector = 0);

} // namespace lumorph
