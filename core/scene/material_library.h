#pragma once

#include <string>
#include <vector>

#include "core/scene/material.h"

namespace lumorph {

/// Materials to choose from, each with its own name: paper, water, wood, brick, a map, ice and others. Their pictures
/// are bundled resources, and a repeat is as large as it looks good on the tablet.
[[nodiscard]] std::vector<Material> readyMaterials();

/// One of them by its name ("Water"). Throws InvalidInput naming those there are.
[[nodiscard]] Material readyMaterial(const std::string& name);

} // namespace lumorph
