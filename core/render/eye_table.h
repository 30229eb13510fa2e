#pragma once

#include <glm/vec2.hpp>

#include "core/render/eye_surfaces.h"

namespace lumorph {

/// Cells of the table's top: many for lenses that bend what is straight, few for those that do not.
inline constexpr glm::ivec2 kTableForLenses{48, 36};
inline constexpr glm::ivec2 kStraightTable{8, 6};

/// Makes a mesh the table's top: metres, about the origin, looking up; its coordinates are x and z.
void shapeTable(EyeMesh& table, glm::vec2 size, glm::ivec2 cells);

} // namespace lumorph
