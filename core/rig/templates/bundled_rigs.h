#pragma once

#include "core/rig/rig.h"
#include "core/rig/templates/sheet_device.h"

namespace lumorph {

/// Measures in centimetres.
struct TabletSize {
    double width = 21.0;
    double depth = 15.0;
    double reach = 8.42;           ///< height of the upright flaps of the long edges above the table
    double cornerAlongWidth = 6.6; ///< from a corner to where its bend line ends, along the width
    double cornerAlongDepth = 6.9;
};

/// The tablet of the paper (R1): 21 x 15 x 2 cm, one flexible sheet on a fixed housing. Six levers lift its four
/// corners and the middles of its long edges by 4 cm. To be made by `continuousSheet`; the bundled file has it baked.
/// In other sizes (metres) its parts keep their shares.
[[nodiscard]] SheetDevice tabletDrawing(double width = 0.21, double depth = 0.15, double thickness = 0.002);

/// It as the bundled file has it. Throws DataError when that is missing.
[[nodiscard]] Rig bakedTablet();

/// The same size with a top that is cut into six flaps, which bend upwards by up to 90 degrees.
/// Throws InvalidInput when with other measures a part would vanish.
[[nodiscard]] Rig cutTabletRig(const TabletSize& size = {});

/// Measures in centimetres.
struct PinDisplaySize {
    int columns = 30;
    int rows = 30;
    double pitch = 0.5;
    double pin = 0.47; ///< side of a pin
    double stroke = 10.0;
    double plate = 4.9; ///< height of the plate's top
};

/// Square pins that slide out of a base plate. Throws InvalidInput when the pins would touch or vanish.
[[nodiscard]] Rig pinDisplayRig(const PinDisplaySize& size = {});

/// Measures in centimetres.
struct CushionSize {
    double width = 30.0;
    double depth = 30.0;
    double height = 4.0;
    double swell = 6.0; ///< of the middle of a chamber
    int columns = 2;
    int rows = 2;
};

/// A cushion whose chambers swell: morph targets, one a chamber. Throws InvalidInput when a part would vanish.
[[nodiscard]] Rig cushionRig(const CushionSize& size = {});

/// A strip of four links: a skin whose three joints curl it upwards.
[[nodiscard]] Rig ribbonRig();

/// A slab whose top swells in three places: morph targets.
[[nodiscard]] Rig hillsRig();

} // namespace lumorph
