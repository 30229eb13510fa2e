#pragma once

#include <vector>

#include <QImage>

#include "core/base/progress.h"

namespace lumorph::studio {

/// A picture of each ready material, in their order, for a job: their textures are read. Throws Cancelled.
[[nodiscard]] std::vector<QImage> paintShelf(int side, const Progress& progress);

} // namespace lumorph::studio
