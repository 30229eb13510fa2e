#pragma once

#include <vector>

#include <QImage>

#include "app/studio/look/palette.h"
#include "core/voxels/bit_columns.h"

namespace lumorph::studio {

/// A target on the device and what the device takes of it, as heights: one a column of voxels, along x first, then z.
struct FitRelief {
    glm::ivec3 dimensions{0};
    std::vector<float> rest;   ///< voxels above the frame's bottom; 0 where the body is not
    std::vector<float> wanted; ///< the same for what the target fills, at least as high as `rest`
    std::vector<float> taken;  ///< what the device covers
};

/// Columns are joined so that the longer side has `most` at most. All three grids have one shape.
[[nodiscard]] FitRelief reliefOf(const BitColumns& body, const BitColumns& wanted, const BitColumns& covered,
                                 int most = 96);

/// Seen from above, a little from the right, without perspective: plain where target and device meet, in the colour of
/// what is unmatched where the target stands higher, of what is overfilled where the device does. Transparent beside.
[[nodiscard]] QImage pictureOf(const FitRelief& relief, const QSize& pixels, const Palette& palette);

} // namespace lumorph::studio
