#pragma once

#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "core/base/progress.h"
#include "core/base/units.h"
#include "core/rig/rig.h"

namespace lumorph {

/// A line drawn across a sheet, along which a part of it, a flap, bends upwards. Points are (x, z), metres.
struct BendLine {
    enum class Ends {
        free,   ///< the flap is as wide as the line: slits cut it free at both ends
        joined, ///< the line runs on to the sheet's edges, so that nothing has to be cut where it gets there
    };
    enum class Side { smaller, left, right }; ///< which part moves; left and right of the way from `from` to `to`

    std::string name;
    glm::dvec2 from{0.0};
    glm::dvec2 to{0.0};
    Ends ends = Ends::joined;
    Side side = Side::smaller;
    Angle angle = Angle::degrees(90.0); ///< at full stroke: more than 0 and at most 90 degrees
    bool operator==(const BendLine&) const = default;
};

/// How the top of a sheet device becomes movable.
enum class SheetTop {
    cut,        ///< into flaps: slits part each from the rest, and it bends along its line
    continuous, ///< one elastic sheet, clamped on a pad and lifted by a lever for each bend line
};

/// A flexible sheet on a fixed housing, as it is drawn from above: x to the right, z towards the viewer (down the
/// page), metres.
struct SheetDevice {
    std::string name = "sheet";
    SheetTop top = SheetTop::cut;
    std::string material = "NinjaFlex"; ///< of a continuous top, by its name in `sheetMaterials`
    /// Where a continuous top is fixed on the housing; empty: on what lies behind all bend lines.
    std::vector<glm::dvec2> pad;
    std::vector<glm::dvec2> outline; ///< of the sheet, either way round
    double thickness = 0.002;        ///< of the sheet
    double housing = 0.016;          ///< height of the housing; the sheet lies kSheetAboveHousing above it
    double arc = 0.02;               ///< length of sheet that a bend curves
    std::vector<BendLine> bends;
    bool operator==(const SheetDevice&) const = default;
};

inline constexpr std::size_t kMaxBendLines = 64;
inline constexpr double kSheetAboveHousing = 0.002; ///< metres

struct FlapClearance;
/// How far the flaps of such a sheet keep from one another (see flap_layout.h). Throws InvalidInput as `sheetRig` does
/// for its measures.
[[nodiscard]] FlapClearance flapClearance(const SheetDevice& device);

/// How finely a continuous top is solved: `preview` within about a second, `full` in about half a minute for six bend
/// lines. Cut tops know no difference.
enum class SheetQuality { preview, full };

/// A cut sheet as a closed solid over a housing that is the convex hull of the outline and a little more. Each flap is
/// what can be seen of the sheet from its bend line, straight on, up to the sheet's edge, another bend line or a flap
/// before it in the list; where that is not the sheet's edge a slit parts it from the rest. So a flap that rises draws
/// back within its own outline and meets nothing, and skirts under its rim hold the way that it has gone
/// (`RigParts::pathInside`). The solid is looked over in a few joint states before it is given. An actuator a bend
/// line, in their order; the rig keeps the drawing (`RigParts::drawing`). Throws InvalidInput naming the measure or the
/// bend line that stands in the way; Cancelled. A continuous sheet is made by `continuousSheet` (see there).
[[nodiscard]] Rig sheetRig(const SheetDevice& device, const Progress& progress = {},
                           SheetQuality quality = SheetQuality::full);

/// What part of the sheet each bend line moves, or of a continuous one would move alone: a polygon of points (x, z),
/// metres, a line. Of the solid above, but without it, in a millisecond or so. Throws InvalidInput as `sheetRig` does
/// where a line has no room.
[[nodiscard]] std::vector<std::vector<glm::dvec2>> sheetFlaps(const SheetDevice& device);

} // namespace lumorph
