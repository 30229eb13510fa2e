#pragma once

#include <glm/vec2.hpp>

#include "core/render/eye_surfaces.h"

namespace lumorph {

/// Makes a mesh the table's top: metres, about the origin, looking up; its coordinates are x and z.
void shapeTable(EyeMesh& table, glm::vec2 size);

} // namespace lumorph
