#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// A polygon with more corners is refused: cutting it into triangles takes time with their square.
inline constexpr std::size_t kMaxPolygonCorners = 10'000;

/// A surface has about two triangles a vertex, a solid cut into tetrahedra a dozen; with more than so many, most repeat
/// one another and only take memory.
inline constexpr std::size_t kMaxFacesAVertex = 100;

/// Throws DataError for more faces than that: `place` is where the file says so.
void checkFaceCount(std::uint64_t faces, std::uint64_t vertices, const std::string& place);

/// Gathers what a parser reads and makes the mesh of it. Polygons may come before their vertices;
/// indices are checked at the end, and errors say where each polygon stood.
class MeshBuilder {
public:
    /// `placeName` is what the places of polygons are called: "line" or "face".
    MeshBuilder(std::string name, std::string placeName);

    /// Takes memory ahead for what a file of `bytesLeft` bytes can hold of the counts it promises.
    void reserve(std::uint64_t vertices, std::uint64_t polygons, std::size_t bytesLeft);

    void addVertex(const glm::vec3& position) { positions_.push_back(position); }
    /// Adds a corner to the polygon under way; indices count from 0 and may be out of range for now.
    void addCorner(std::int64_t index) { corners_.push_back(index); }
    /// Ends the polygon under way. One of fewer than three corners (a point, an edge) is dropped.
    /// Throws DataError beyond kMaxPolygonCorners or kMaxTriangles.
    void endPolygon(std::size_t place);

    [[nodiscard]] std::size_t vertexCount() const noexcept { return positions_.size(); }
    [[nodiscard]] std::size_t cornersUnderWay() const noexcept { return corners_.size() - polygonStart_; }

    /// Checks counts and indices and triangulates; leaves the builder empty.
    [[nodiscard]] TriangleMesh finish();

private:
    struct Polygon {
        std::size_t end; ///< one past its last corner
        std::size_t place;
    };
    [[noreturn]] void fail(std::size_t place, const std::string& why, const std::string& remedy) const;
    void checkIndices(std::span<const std::int64_t> corners, std::size_t place) const;

    std::string name_;
    std::string placeName_;
    std::vector<glm::vec3> positions_;
    std::vector<std::int64_t> corners_;
    std::vector<Polygon> polygons_;
    std::size_t polygonStart_ = 0;
    std::size_t triangles_ = 0;
};

} // namespace lumorph
