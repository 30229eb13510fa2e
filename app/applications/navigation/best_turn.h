#pragma once

#include "app/applications/navigation/map.h"
#include "app/applications/navigation/map_view.h"
#include "core/motion/stroke_fit.h"
#include "core/rig/rig.h"

namespace lumorph::navigation {

/// Turns views so that a device can take the shape of their land: its flaps are few, and what they lift from one side
/// is a ridge from another.
class BestTurn {
public:
    static constexpr double kMostTurn = 1.5707963267948966; ///< either way, radians: a tablet is the same from behind
    static constexpr int kTurns = 6;                        ///< tried each way

    /// Takes tens of milliseconds.
    explicit BestTurn(const Rig& rig);

    /// A view of the same place at a turn around its own at which the device comes closest to the land: of those that
    /// differ little, the nearest. Nothing beyond the map comes into view.
    [[nodiscard]] MapView of(const Map& map, const MapView& view) const;
    /// How alike the land of a view and the device's best shape for it are: their correlation, -1 to 1.
    [[nodiscard]] double likeness(const Map& map, const MapView& view) const;

private:
    TopSurface surface_;
    StrokeFit fit_;
};

} // namespace lumorph::navigation
