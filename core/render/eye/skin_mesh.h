#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/geometry/surface_shading.h"
#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// The device's surface as it is textured: mapped in metres of its rest shape (the top by x and z, the sides hanging
/// from it like cloth), so that a picture sticks to the sheet while it bends. Large triangles are cut so that a lens
/// may distort them. Immutable.
class SkinMesh {
public:
    /// Throws InvalidInput for an index beyond the positions.
    explicit SkinMesh(const TriangleMesh& rest);

    [[nodiscard]] const std::vector<glm::uvec3>& triangles() const noexcept { return triangles_; }
    /// One a drawn vertex: metres to the right and towards the user, as on a page.
    [[nodiscard]] const std::vector<glm::vec2>& coordinates() const noexcept { return coordinates_; }
    [[nodiscard]] const std::vector<glm::vec3>& restPositions() const noexcept { return restPositions_; }
    [[nodiscard]] std::size_t meshVertexCount() const noexcept { return meshVertexCount_; }
    [[nodiscard]] bool closed() const noexcept { return shading_.closed(); }

    /// The mesh at rest with its large triangles cut.
    [[nodiscard]] const TriangleMesh& cutMesh() const noexcept { return cut_; }
    /// Its positions for these of the mesh's vertices.
    [[nodiscard]] std::vector<glm::vec3> cutPositions(std::span<const glm::vec3> positions) const;

    /// Positions and normals of all drawn vertices for these positions of the cut mesh. Where `soft` is not empty it
    /// holds other normals of the cut mesh's vertices, of which `share` is mixed in.
    void shade(std::span<const glm::vec3> cutPositions, std::span<const glm::vec3> soft, float share,
               std::vector<glm::vec3>& outPositions, std::vector<glm::vec3>& outNormals) const;

private:
    /// A point halfway between two earlier ones.
    struct Midpoint {
        std::uint32_t a, b;
    };
    static TriangleMesh refined(const TriangleMesh& rest, std::vector<Midpoint>& midpoints);
    void split();

    std::size_t meshVertexCount_ = 0;
    std::vector<Midpoint> midpoints_;
    TriangleMesh cut_;
    SurfaceShading shading_;
    std::vector<std::uint32_t> sources_; ///< of a drawn vertex in the shading
    std::vector<glm::uvec3> triangles_;
    std::vector<glm::vec2> coordinates_;
    std::vector<glm::vec3> restPositions_;
};

} // namespace lumorph
