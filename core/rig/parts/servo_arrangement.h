#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/rig/parts/bed_split.h"
#include "core/rig/parts/build_plan.h"
#include "core/rig/parts/servo_seat.h"
#include "core/rig/parts/sheet_layout.h"

namespace lumorph {

/// Heights of a housing, millimetres above its bottom.
struct HousingHeights {
    static constexpr double kFloor = 1.6;
    static constexpr double kLid = 2.0;
    static constexpr double kWall = 2.0;

    HousingHeights(const SheetLayout& sheet, const ServoSeat& seat, const ServoBody& body);
    double tray = 0.0;   ///< top of the walls, where the lid lies
    double plinth = 0.0; ///< solid foot of the seats
    double below = 0.0;  ///< from the sheet's underside down to the shafts
    double deeper = 0.0; ///< than the rig is drawn
};

/// A servo in its seat under its flap.
struct PlacedServo {
    std::size_t flap = 0;
    SeatPlace seat;
    std::optional<Lever> lever; ///< none where the flap is too short for one
    PlanePolygon slot;          ///< in the lid, for the lever; without one a hole for a wire
};

struct HousingArrangement {
    static constexpr double kPost = 3.2;     ///< radius of a screw post
    static constexpr double kBoardRim = 1.4; ///< thickness of the rim around the board
    std::vector<PlacedServo> servos;         ///< one a flap
    std::vector<glm::dvec2> posts;           ///< for the screws of the lid
    std::optional<PlanePolygon> board;       ///< its outline; none where it has no room
    PlanePolygon cable;                      ///< opening in the wall
    std::size_t leverless = 0;               ///< flaps under which no lever fits
};

/// Finds room in a housing for servos, screw posts and the board. Throws InvalidInput naming the actuator for whose
/// servo there is none, or when no lid can be screwed on.
[[nodiscard]] HousingArrangement arrangeHousing(const SheetLayout& sheet, const std::vector<std::string>& names,
                                                const PartOptions& options, const HousingHeights& heights,
                                                const BedSplit& split);

} // namespace lumorph
