#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/units.h"
#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// A fold of a surface along one edge of its mesh.
struct Crease {
    std::array<std::uint32_t, 2> vertices{};  ///< of the mesh
    std::array<std::uint32_t, 2> triangles{}; ///< beside it, to the left seen from the first vertex, and to the right
    Angle angle;                              ///< by which the surface turns across it; negative in a valley
};

/// How a fold is told from a curve.
struct CreaseSearch {
    Angle threshold = Angle::degrees(8.0);
    double radius = 0.012; ///< metres to either side over which turning counts as one fold
};

/// Finds the folds of a surface that deforms (R30). A sheet of fine triangles bends over many edges by little each: so
/// the turning is summed up along a walk over the surface, straight across an edge and to both sides, and of several
/// edges along one bend the one in its middle counts. Immutable; safe to share between threads.
class CreaseFinder {
public:
    /// Vertices at the same place of `rest` count as one. Throws InvalidInput for an index beyond the positions.
    explicit CreaseFinder(const TriangleMesh& rest);

    /// The folds that turn by at least the threshold. Positions are one a vertex of the rest mesh, metres.
    [[nodiscard]] std::vector<Crease> find(std::span<const glm::vec3> positions, const CreaseSearch& search) const;

    /// Normals of all vertices as if folds narrower than about `radius` metres were round.
    [[nodiscard]] std::vector<glm::vec3> softNormals(std::span<const glm::vec3> positions, double radius) const;

private:
    struct Edge {
        std::uint32_t a, b;        ///< vertices, as the left triangle walks along them
        std::uint32_t left, right; ///< triangles
    };
    /// Two places side by side, with or without two triangles between them.
    struct Link {
        std::uint32_t a, b;
        float length; ///< at rest
    };
    struct Turning;
    struct Sums;
    class Walk;
    [[nodiscard]] Sums sumsOf(const Turning& turning, float radius) const;
    [[nodiscard]] bool isMiddle(const Turning& turning, const std::vector<float>& near, float radius,
                                std::size_t edge) const;
    [[nodiscard]] std::vector<Crease> withoutScraps(std::span<const glm::vec3> positions, std::vector<Crease> creases,
                                                    const std::vector<bool>& sharp, double shortest) const;

    std::vector<glm::uvec3> triangles_; ///< of the mesh's vertices
    std::vector<std::uint32_t> places_; ///< for each vertex the first at its place
    std::vector<Edge> edges_;           ///< between two triangles
    std::vector<Link> links_;
    std::vector<glm::ivec3> edgesOf_; ///< for each triangle its edges, -1 at the border
};

/// Vertices of strips along creases, to be drawn upon the surface.
struct CreaseStrips {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec2> across;       ///< -1 to 1 over the width, and the strength in [0, 1]
    std::vector<std::uint32_t> vertices; ///< of the mesh that each is nearest to
    std::vector<glm::uvec3> triangles;
};
/// Strips `width` metres wide that fold with the surface; their strength grows from nothing at the threshold.
[[nodiscard]] CreaseStrips creaseStrips(std::span<const Crease> creases, std::span<const glm::uvec3> triangles,
                                        std::span<const glm::vec3> positions, double width, Angle threshold);

} // namespace lumorph
