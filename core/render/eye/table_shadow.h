#pragma once

#include <optional>

#include "core/render/eye/lookup_region.h"
#include "core/scene/show_frame.h"

namespace lumorph {

/// Box in the world of what throws shadows, but for what is far from the device, which counts with all it can reach, so
/// that its shadow does not swim while it moves.
[[nodiscard]] Box casterBounds(const ShowFrame& frame);

/// What holds all shadows of a frame on the table in this light, edges included; empty where there are none. None: they
/// have no end.
[[nodiscard]] std::optional<TableArea> shadowsOnTable(const ShowFrame& frame, const PosedLight& light);

} // namespace lumorph
