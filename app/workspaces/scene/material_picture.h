#pragma once

#include <QImage>

#include "core/scene/material.h"
#include "core/scene/scene_assets.h"

namespace lumorph::studio {

/// A ball of a material, 12 cm across, on nothing: a picture of `side` pixels squared. For any thread; pictures that
/// are not in `assets` are left out.
[[nodiscard]] QImage paintMaterial(const Material& material, const SceneAssets* assets, int side);

} // namespace lumorph::studio
