#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/rig/parts/layered_solid.h"
#include "core/rig/rig.h"
#include "core/rig/templates/flap_layout.h"

namespace lumorph {

/// A flap as its actuator bends it. Its frame has the bend line's middle as origin, and `along` to the right of
/// `across`; millimetres.
struct SheetFlap {
    std::size_t actuator = 0;
    LineFrame frame;
    double arc = 0.0;
    Angle angle;      ///< at full stroke
    double low = 0.0; ///< along the line, the flap's ends
    double high = 0.0;
    std::vector<PlanePolygon> triangles; ///< that move, in its frame; none of a continuous sheet

    /// Of a continuous sheet: the lever that lifts the frame's origin, and the slot in which its nose is captive.
    struct Captive {
        double arm = 0.0;  ///< from the shaft to the nose
        double lift = 0.0; ///< of the nose at full stroke
    };
    std::optional<Captive> captive;

    /// How far the flap reaches from its bend line at a place along it; 0 where there is no flap.
    [[nodiscard]] double depthAt(double along) const;
};

/// What a rig of a sheet on a housing is made of, read from its mesh at rest; millimetres, heights above its bottom.
struct SheetLayout {
    PlanePolygon housing;            ///< convex, counter-clockwise
    std::vector<PlanePolygon> sheet; ///< with its slits, even-odd
    std::vector<PlanePolygon> still; ///< what no actuator moves of it, even-odd
    double ledge = 0.0;              ///< top of the housing
    double underside = 0.0;          ///< of the sheet
    double top = 0.0;
    std::vector<SheetFlap> flaps;
};

/// None where the rig is no sheet on a housing: something moves otherwise than by bending upwards or as the levers of a
/// drawn continuous sheet do, or there is no level top, ledge and bottom.
[[nodiscard]] std::optional<SheetLayout> sheetPlanOf(const Rig& rig);

/// The borders of the triangles that `keep` accepts, seen from above, on the page in millimetres; even-odd.
/// (x right, y away from the viewer.)
[[nodiscard]] std::vector<PlanePolygon> bordersOf(const TriangleMesh& mesh, const std::vector<bool>& keep);

} // namespace lumorph
