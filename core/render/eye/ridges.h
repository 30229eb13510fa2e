#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace lumorph {

/// An edge between two triangles of a mesh.
struct MeshEdge {
    std::uint32_t a, b;        ///< vertices, as the left triangle walks along them
    std::uint32_t left, right; ///< triangles
};

/// A piece of a ridge or valley line, straight through one triangle from one of its edges to another.
struct RidgePiece {
    std::uint32_t triangle = 0;
    std::array<int, 2> edges{};             ///< -1 at a border
    std::array<std::uint32_t, 2> nearest{}; ///< vertices, of those edges' ends
    std::array<float, 2> parts{};           ///< of the edges' lengths, by which the ends are away from these
    std::array<glm::vec3, 2> ends{};        ///< metres
    glm::vec3 across{0.0F};                 ///< in which the surface bends most
};

/// Finds the ridge and valley lines of a surface that deforms: where the larger principal curvature, smoothed, is
/// extremal along its own direction (Ohtake, Belyaev and Seidel 2004). Curvature is that of triangle meshes: turning
/// across edges, summed over a neighbourhood (Cohen-Steiner and Morvan 2003). Immutable; safe to share between threads.
class RidgeTracer {
public:
    /// `radius`: metres over which curvature is smoothed: a Gaussian of 0.8 of it. Edges that are sharper than `sharp`
    /// radians at rest part surfaces from one another. `places`: for each vertex the first at its place.
    RidgeTracer(std::span<const glm::vec3> rest, std::span<const glm::uvec3> triangles,
                std::span<const std::uint32_t> places, std::span<const MeshEdge> edges, float radius, float sharp);

    /// `angles`: by which the surface turns across each edge, radians; `normals`: of the triangles.
    [[nodiscard]] std::vector<RidgePiece> trace(std::span<const glm::vec3> positions,
                                                std::span<const glm::vec3> normals,
                                                std::span<const float> angles) const;

    /// What counts for a vertex, and how much.
    struct Share {
        std::uint32_t of; ///< an edge or a triangle
        float weight;
    };

private:
    /// A vertex of one of the surfaces.
    struct Node {
        std::uint32_t vertex;
        std::vector<Share> edges, triangles;
        std::vector<std::uint32_t> around; ///< its triangles
    };
    struct Bend {
        float most = 0.0F;      ///< size of the larger principal curvature, 1 / m
        glm::vec3 across{0.0F}; ///< its direction
        float growth = 0.0F;    ///< of `most` along that
    };
    [[nodiscard]] std::vector<Bend> bendsOf(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                                            std::span<const float> angles) const;
    void addPiece(std::uint32_t triangle, std::span<const glm::vec3> positions, const std::vector<Bend>& bends,
                  std::vector<RidgePiece>& pieces) const;

    std::vector<glm::uvec3> triangles_;
    std::vector<MeshEdge> edges_;
    std::vector<glm::uvec3> nodesOf_; ///< of each triangle's corners
    std::vector<glm::ivec3> edgesOf_; ///< of each triangle, the one from corner k to k + 1; -1 at a border
    std::vector<Node> nodes_;
};

} // namespace lumorph
