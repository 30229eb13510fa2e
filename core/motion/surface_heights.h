#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// Looks down on meshes at fixed points again and again: how high is the uppermost surface there?
class SurfaceHeights {
public:
    /// Points are (x, z), metres; those that are not finite are never met.
    explicit SurfaceHeights(std::span<const glm::vec2> points);

    /// Where the mesh has a surface at the k-th point, out[k] becomes the height of its uppermost one (also below what
    /// stood there); the others stay as they are. Triangles with corners that are not finite are passed over.
    void read(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles, std::span<float> out);

private:
    void readTriangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

    std::vector<glm::vec2> points_;
    glm::dvec2 origin_{0.0};
    double cell_ = 1.0;
    glm::ivec2 cells_{0};
    std::vector<std::uint32_t> starts_; ///< of each cell in `order_`
    std::vector<std::uint32_t> order_;
    std::vector<float> highest_;
};

/// The same once, for a mesh in the frame of the points.
void heightsOfMesh(const TriangleMesh& mesh, std::span<const glm::vec2> points, std::span<float> out);

} // namespace lumorph
