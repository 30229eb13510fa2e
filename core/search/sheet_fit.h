#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/units.h"
#include "core/geometry/triangle_mesh.h"
#include "core/mdf/placement.h"
#include "core/rig/templates/flap_layout.h"
#include "core/rig/templates/sheet_device.h"

namespace lumorph {

/// How well a sheet with some flaps can take the shape of targets, without making its solid: thousands of designs a
/// second where `LibraryMatcher` takes one.
///
/// A flap bends about its line and stays within its outline seen from above, so each column of voxels belongs to one
/// flap alone, and what the flap passes there lies between the sheet and the highest place its surface has had over the
/// column: the arc, the straight sheet beyond it, or the rim as it went by. The best joint state then follows from sums
/// over columns (see `LibraryMatcher`). Differs from the true volume by the slits' depth and the edges' thickness.
/// Immutable; safe to share between threads.
class SheetFit {
public:
    struct Options {
        int columns = 64; ///< on the outline's longer side
        int levels = 17;
    };

    /// Targets as they stand, device coordinates; what lies below the sheet's top is not looked at. `angle` is a flap's
    /// full stroke. Throws InvalidInput when no target reaches above the sheet, Cancelled.
    SheetFit(const SheetDevice& sheet, Angle angle, std::span<const Target> targets, const Options& options,
             const Progress& progress = {});
    ~SheetFit();
    SheetFit(SheetFit&&) noexcept;

    /// What some flaps are good for.
    struct Worth {
        double fit = 0.0; ///< mean IoU over the targets of the best joint states, in [0, 1]
        /// What they add to a device that fits well already: the mean over the targets of voxels won less four fifths
        /// of those overfilled, at each flap's best level, relative to the target. So one flap alone can be told a good
        /// one.
        double gain = 0.0;
    };
    [[nodiscard]] Worth of(const std::vector<Flap>& flaps) const;
    /// IoU of each target.
    [[nodiscard]] std::vector<double> each(const std::vector<Flap>& flaps) const;

private:
    struct Tables;
    std::unique_ptr<const Tables> tables_;
};

} // namespace lumorph
