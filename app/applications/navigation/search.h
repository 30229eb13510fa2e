#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "app/applications/navigation/map.h"

namespace lumorph::navigation {

/// The place that is most likely meant by a name in either language: capitals, accents, apostrophes and words left out
/// do not matter, nor do one or two slips of the fingers. Nothing where none comes near.
[[nodiscard]] std::optional<std::size_t> find(std::span<const Place> places, std::string_view name);

} // namespace lumorph::navigation
