#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/geometry/model.h"

namespace lumorph {

/// Soft dunes of different heights over the corners and edges of a 21 x 15 cm tablet.
[[nodiscard]] Model dunesModel();

/// A long wave that travels across such a tablet, as the animation "swell" of four seconds: two
/// standing waves a quarter of a wavelength apart, as morph targets, and their changing shares.
[[nodiscard]] Model swellModel();

/// Six petals over the corners and the long edges of such a tablet, which rise and sink one after another, as the
/// animation "bloom" of six seconds: the mean shape, and the first harmonics of the loop as morph targets.
[[nodiscard]] Model bloomModel();

/// Plain shapes of the same footprint, each named by what it is: what a maker may ask a device for.
[[nodiscard]] std::vector<std::pair<std::string, Model>> shapeModels();

} // namespace lumorph
