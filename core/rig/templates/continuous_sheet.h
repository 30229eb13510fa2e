#pragma once

#include "core/base/progress.h"
#include "core/rig/rig.h"
#include "core/rig/sheet/elastic_sheet.h"
#include "core/rig/templates/sheet_device.h"

namespace lumorph {

/// The elastic sheet that a device with a continuous top has. It is clamped on the pad. Under what each bend line would
/// move alone, near the end that is farthest from the line, a lever holds a slot of at most 3 cm parallel to the line.
/// It lifts 0.8 of the way to the pad at a bend line's 90 degrees, and 35.8 mm at most; its shaft lies 8 mm below the
/// sheet, and its arm is as long as that needs. Throws InvalidInput naming the bend line that has no room for a lever,
/// or what is wrong with the sheet.
[[nodiscard]] ElasticSheet elasticSheetOf(const SheetDevice& device);

/// A device with a continuous top as a closed solid: the sheet's mesh over a housing that is the convex hull of the
/// outline and a little more, with skirts under the rim that hold the way that it has gone. Its levers get the cheapest
/// servos of the table of which half the stall torque holds them. An actuator a bend line, in their order. The solid is
/// looked over in a few joint states before it is given. Throws InvalidInput as `elasticSheetOf` and `bakeJointStates`,
/// and where no servo is strong enough; Cancelled.
[[nodiscard]] Rig continuousSheet(const SheetDevice& device, SheetQuality quality, const Progress& progress = {});

} // namespace lumorph
