#include "core/render/eye_table.h"

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace lumorph {
namespace {

constexpr glm::ivec2 kGrid{48, 36};

std::vector<glm::uvec3> gridTriangles() {
    std::vector<glm::uvec3> triangles;
    const auto width = static_cast<std::uint32_t>(kGrid.x) + 1;
    for (std::uint32_t row = 0; row < static_cast<std::uint32_t>(kGrid.y); ++row)
        for (std::uint32_t column = 0; column + 1 < width; ++column) {
            const std::uint32_t a = row * width + column;
            triangles.emplace_back(a, a + width, a + width + 1);
            triangles.emplace_back(a, a + width + 1, a + 1);
        }
    return triangles;
}

} // namespace

// A grid, because a lens bends what is straight.
void shapeTable(EyeMesh& table, glm::vec2 size) {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec2> coordinates;
    for (int row = 0; row <= kGrid.y; ++row)
        for (int column = 0; column <= kGrid.x; ++column) {
            const glm::vec2 at = size * (glm::vec2(column, row) / glm::vec2(kGrid) - 0.5F);
            positions.emplace_back(at.x, 0.0F, at.y);
            coordinates.push_back(at);
        }
    table.setTopology(gridTriangles(), coordinates);
    table.setShape(positions, std::vector<glm::vec3>(positions.size(), glm::vec3(0.0F, 1.0F, 0.0F)));
}

} // namespace lumorph
