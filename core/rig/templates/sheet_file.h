#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

#include "core/rig/templates/sheet_device.h"

namespace lumorph {

/// A sheet device from an outline in an SVG file (see `svgOutline`) and bend lines in a JSON file:
/// {"bends": [{"name": "left", "from": [2, 3], "to": [2, 12], "ends": "joined" | "free",
///             "side": "smaller" | "left" | "right", "angle": 90}, ...],
///  "name": "...", "top": "cut" | "continuous", "thickness": 0.2, "housing": 1.6, "arc": 2,
///  "material": "NinjaFlex", "pad": [[x, y], ...]}
/// in centimetres and degrees, x to the right and y down from the page's upper left corner; `bends` and in each `from`
/// and `to` are required. The device's origin is the middle of the outline.
/// Throws DataError naming the file and the entry.
[[nodiscard]] SheetDevice readSheetDevice(const std::filesystem::path& outline, const std::filesystem::path& bends);

/// The outline in an SVG file (see `svgOutline`), its middle at the origin. Throws DataError naming the file.
[[nodiscard]] std::vector<glm::dvec2> readOutline(const std::filesystem::path& file);

/// A drawing as one text: the bends file above with the outline in it, {"outline": [[x, y], ...], "bends": ...}, and
/// the device's origin as that of its points. Numbers have nine decimals: what such a text holds comes back bit by bit.
[[nodiscard]] std::string writeSheetDevice(const SheetDevice& device);
/// The drawing in such a text. Throws DataError naming `subject` and the entry.
[[nodiscard]] SheetDevice parseSheetDevice(std::string_view text, const std::string& subject);

} // namespace lumorph
