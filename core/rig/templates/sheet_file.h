#pragma once

#include <filesystem>

#include "core/rig/templates/sheet_device.h"

namespace lumorph {

/// A sheet device from an outline in an SVG file (see `svgOutline`) and bend lines in a JSON file:
/// {"bends": [{"name": "left", "from": [2, 3], "to": [2, 12], "ends": "joined" | "free",
///             "side": "smaller" | "left" | "right", "angle": 90}, ...],
///  "name": "...", "thickness": 0.2, "housing": 1.6, "arc": 2}
/// in centimetres and degrees, x to the right and y down from the page's upper left corner; `bends` and in each `from`
/// and `to` are required. The device's origin is the middle of the outline.
/// Throws DataError naming the file and the entry.
[[nodiscard]] SheetDevice readSheetDevice(const std::filesystem::path& outline, const std::filesystem::path& bends);

} // namespace lumorph
