#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "core/base/progress.h"
#include "core/rig/templates/sheet_device.h"

namespace lumorph {

/// Why a drawing gives no device.
struct SheetRefusal {
    std::optional<std::size_t> line; ///< the bend line in the way; none: the sheet itself
    std::string subject, why, remedy;
};

/// What a drawing that may be unfinished comes to.
struct SheetPlan {
    /// Of the lines that are not refused, a continuous top solved as a preview; empty where the sheet itself cannot be.
    std::shared_ptr<const Rig> rig;
    std::vector<std::vector<glm::dvec2>> flaps;        ///< one a bend line, as `sheetFlaps`; empty where refused
    std::vector<std::optional<std::size_t>> actuators; ///< one a bend line: its place in the rig; none where refused
    std::vector<SheetRefusal> refusals;

    [[nodiscard]] bool whole() const noexcept { return rig && refusals.empty(); }
};

/// The device of a drawing. Where a bend line stands in the way the others are made without it, so that one sees what
/// is meant and why a line is refused. Throws Cancelled, nothing else.
[[nodiscard]] SheetPlan planSheet(const SheetDevice& device, const Progress& progress = {});

} // namespace lumorph
