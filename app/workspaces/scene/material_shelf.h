#pragma once

#include <vector>

#include <QImage>

#include "core/base/progress.h"
#include "core/scene/material.h"

namespace lumorph::studio {

/// The ready materials of the library, in its order.
[[nodiscard]] std::vector<Material> shelfMaterials();

/// A picture of each, for a job: their textures are read. Throws Cancelled.
[[nodiscard]] std::vector<QImage> paintShelf(int side, const Progress& progress);

} // namespace lumorph::studio
