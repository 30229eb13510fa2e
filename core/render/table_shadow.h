#pragma once

#include <optional>

#include "core/render/lookup_region.h"
#include "core/render/show_frame.h"

namespace lumorph {

/// What holds all shadows of a frame on the table in this light, edges included; empty where there are none. None: they
/// have no end.
[[nodiscard]] std::optional<TableArea> shadowsOnTable(const ShowFrame& frame, const PosedLight& light);

} // namespace lumorph
