#pragma once

#include <filesystem>

#include "core/base/resources.h"
#include "devices/controllers/device_profile.h"
#include "devices/firmware/board_sequence.h"

namespace lumorph {

/// Where the sketch lies that comes with Lumorph: in `firmware/tablet` of the resources once installed, else in
/// `devices/firmware/tablet` of the source tree. Throws DataError where it is missing.
[[nodiscard]] std::filesystem::path sketchFolder(const std::filesystem::path& resources = resourcesFolder());

/// Writes the whole sketch, its channels.h made from the profile, into a new folder inside `parent`, and gives that
/// folder: "tablet", or "tablet-2" and so on where that is there already. The Arduino IDE can open it, since its main
/// file is called as the folder. Whole or not at all; nothing that is there is replaced.
/// With poses the board shows them without a computer.
/// Throws InvalidInput as channelsHeader and posesHeader do, DataError where the sketch is missing, DeviceError where
/// the disk refuses.
[[nodiscard]] std::filesystem::path writeSketch(const DeviceProfile& profile, const std::filesystem::path& parent,
                                                const BoardSequence* poses = nullptr);

} // namespace lumorph
