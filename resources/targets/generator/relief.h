#pragma once

#include <functional>
#include <vector>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// A closed solid on a flat base: a rectangle centred on the origin, its bottom at y = 0 and its top a
/// height over x and z.
struct Relief {
    float width = 0.0F; ///< along x, metres
    float depth = 0.0F; ///< along z, metres
    int columns = 0;    ///< squares of the top along x
    int rows = 0;       ///< squares of the top along z
};

/// Height in metres over a place of the rectangle; positive.
using Height = std::function<double(double x, double z)>;

/// The solid's mesh: first the vertices of the top, row by row, then those of the base. Coordinates are
/// rounded to 10 micrometres, so that every machine makes the same bytes.
[[nodiscard]] TriangleMesh reliefMesh(const Relief& relief, const Height& height);

/// What moves the mesh's top by a height, and leaves its base: one displacement a vertex, rounded too.
[[nodiscard]] std::vector<glm::vec3> reliefDisplacement(const Relief& relief, const TriangleMesh& mesh,
                                                        const Height& height);

} // namespace lumorph
