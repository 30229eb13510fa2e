#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/units.h"
#include "core/geometry/triangle_mesh.h"
#include "core/render/eye/ridges.h"

namespace lumorph {

/// A piece of a fold of a surface.
struct Crease {
    std::array<glm::vec3, 2> ends{};    ///< metres
    std::array<glm::vec3, 2> normals{}; ///< of the triangles beside it, to the left seen from the first end, and right
    std::array<std::uint32_t, 2> vertices{}; ///< of the mesh, nearest to the ends
    Angle angle;                             ///< by which the surface turns across it; negative in a valley
};

/// Finds the folds of a surface that deforms (R30). A sheet bends over many edges by little each: there a fold is the
/// line where it bends most (RidgeTracer), and turns by what a straight walk across it adds up. What turns at a single
/// edge is a fold along that edge; of a mesh of more than 16,000 triangles these alone are found. Immutable; safe to
/// share between threads.
class CreaseFinder {
public:
    static constexpr double kRadius = 0.012; ///< metres to either side over which turning counts as one fold

    /// Vertices at the same place of `rest` count as one. Throws InvalidInput for an index beyond the positions.
    explicit CreaseFinder(const TriangleMesh& rest);

    /// The folds that turn by at least the threshold. Positions are one a vertex of the rest mesh, metres.
    [[nodiscard]] std::vector<Crease> find(std::span<const glm::vec3> positions, Angle threshold) const;

    /// Normals of all vertices as if folds narrower than about `radius` metres were round.
    [[nodiscard]] std::vector<glm::vec3> softNormals(std::span<const glm::vec3> positions, double radius) const;

private:
    using Edge = MeshEdge;
    /// Two places side by side, with or without two triangles between them.
    struct Link {
        std::uint32_t a, b;
        float length; ///< at rest
    };
    struct Turning;
    class Walk;
    /// A crease with what it hangs together with: ends that are the same number are one place.
    struct Piece {
        Crease crease;
        std::array<std::uint32_t, 2> ends{};
        bool sharp = false;
    };
    [[nodiscard]] std::vector<float> turningAround(const Turning& turning) const;
    [[nodiscard]] float turningBeside(const Turning& turning, std::size_t edge) const;
    /// Returns the angles of the edges that are left to be parts of ridges; 0 for the others.
    [[nodiscard]] std::vector<float> addEdges(const Turning& turning, float threshold,
                                              std::vector<Piece>& pieces) const;
    void addRidges(const Turning& turning, std::span<const float> soft, float threshold,
                   std::vector<Piece>& pieces) const;
    static void straighten(std::span<Piece> ridges);
    [[nodiscard]] std::vector<Crease> withoutScraps(const std::vector<Piece>& pieces) const;

    std::vector<glm::uvec3> triangles_; ///< of the mesh's vertices
    std::vector<std::uint32_t> places_; ///< for each vertex the first at its place
    std::vector<Edge> edges_;           ///< between two triangles
    std::vector<Link> links_;
    std::vector<glm::ivec3> edgesOf_; ///< for each triangle its edges, -1 at the border
    std::unique_ptr<const RidgeTracer> ridges_;
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
[[nodiscard]] CreaseStrips creaseStrips(std::span<const Crease> creases, double width, Angle threshold);

} // namespace lumorph
