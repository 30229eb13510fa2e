#pragma once

#include <memory>

#include <glm/vec3.hpp>

#include "core/geometry/triangle_mesh.h"

namespace lumorph::test {

/// An independent judge of what is inside a mesh: CGAL's Side_of_triangle_mesh, asked for each
/// connected piece; a point is inside when any piece holds it.
class InsideOracle {
public:
    explicit InsideOracle(const TriangleMesh& mesh);
    ~InsideOracle();
    [[nodiscard]] bool operator()(const glm::dvec3& point) const;

private:
    struct Pieces;
    std::unique_ptr<Pieces> pieces_;
};

/// Whether a closed box and a triangle share a point, by CGAL's exact predicates.
[[nodiscard]] bool boxMeetsTriangle(const glm::dvec3& low, const glm::dvec3& high, const glm::dvec3& a,
                                    const glm::dvec3& b, const glm::dvec3& c);

/// Whether triangles of a mesh cross: CGAL's Polygon_mesh_processing::does_self_intersect. Open or not manifold meshes,
/// which CGAL's own mesh cannot hold, count as crossing.
[[nodiscard]] bool crossesItself(const TriangleMesh& mesh);

} // namespace lumorph::test
