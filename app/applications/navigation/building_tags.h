#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "app/applications/navigation/map.h"

namespace lumorph::navigation {

/// A length as OpenStreetMap writes it: metres without a unit, `21.9 m`, `72 ft`, `72'`, `72'2"`. Nothing where it is
/// no such length.
[[nodiscard]] std::optional<double> metresIn(std::string_view text);

/// What tags say of a building, metres over its ground.
struct BuildingShape {
    std::optional<double> height; ///< to its top with its roof; nothing: the tags do not say
    double from = 0.0;            ///< where it begins
    double roof = 0.0;            ///< how much of the height is roof
    Building::Roof form = Building::Roof::flat;
};

/// The value of a tag or property; empty: there is none.
using TagValue = std::function<std::string(const char* name)>;

/// By `height` and the like, else by storeys of 3 m: `building:levels` or `levels` with `roof:levels` above them, and 1
/// m for what is over the topmost ceiling where the roof says nothing else.
[[nodiscard]] BuildingShape buildingShape(const TagValue& tag);

} // namespace lumorph::navigation
