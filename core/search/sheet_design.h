#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/rig/rig.h"
#include "core/rig/templates/flap_layout.h"
#include "core/rig/templates/sheet_device.h"

namespace lumorph {

/// A sheet device that makes a rig, as far as its mesh and its actuators tell: outline, thickness, housing, arc, and a
/// bend line for each actuator. Of a rig without actuators a blank sheet, 2 mm thick with an arc of 2 cm.
/// Throws InvalidInput naming the actuator that is no bend of a flat sheet, or the rig whose outline is not convex (its
/// slits hide which notches are its own: such a one is given as a drawing).
[[nodiscard]] SheetDevice sheetDeviceOf(const Rig& rig);

/// Designs of one sheet that differ in their bend lines, as points of the unit cube: six numbers a line (whether there
/// is one, its middle along x and z, its direction, its length, whether its flap is cut free or joined).
class SheetDesigns {
public:
    static constexpr std::size_t kGenes = 6;
    enum Gene : std::size_t { kThere, kMiddleX, kMiddleZ, kDirection, kLength, kEnds };

    /// `sheet` without its bend lines, `most` of which a design may have. Throws InvalidInput for none or more than
    /// kMaxBendLines, or a sheet that cannot be built.
    SheetDesigns(SheetDevice sheet, std::size_t most);

    [[nodiscard]] const SheetDevice& sheet() const noexcept { return sheet_; }
    [[nodiscard]] std::size_t mostLines() const noexcept { return most_; }
    [[nodiscard]] std::size_t dimension() const noexcept { return most_ * kGenes; }
    /// How far a flap bends at full stroke: 90 degrees, or less where the sheet is too thick for its arc.
    [[nodiscard]] Angle angle() const noexcept { return angle_; }

    /// The flaps of a point, in the order of its lines: a line whose flap finds no room is left out.
    [[nodiscard]] std::vector<Flap> flapsOf(std::span<const double> point) const;
    /// The device of a point, with those lines.
    [[nodiscard]] SheetDevice deviceOf(std::span<const double> point) const;
    /// The point of a device whose lines lie on this sheet; of more than there is room for the first ones.
    [[nodiscard]] std::vector<double> pointOf(const SheetDevice& device) const;

private:
    [[nodiscard]] std::vector<BendLine> linesOf(std::span<const double> point) const;
    [[nodiscard]] std::vector<Flap> layOut(std::vector<BendLine>& lines) const;

    SheetDevice sheet_;
    std::size_t most_;
    Angle angle_;
    glm::dvec2 low_{0.0}; ///< corner of the outline's box, metres
    glm::dvec2 size_{0.0};
    std::vector<glm::dvec2> page_; ///< the outline on the page, millimetres
    FlapClearance clearance_;
};

} // namespace lumorph
