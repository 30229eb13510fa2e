#include "core/render/eye_table.h"

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace lumorph {
namespace {

std::vector<glm::uvec3> gridTriangles(glm::ivec2 cells) {
    std::vector<glm::uvec3> triangles;
    const auto width = static_cast<std::uint32_t>(cells.x) + 1;
    for (std::uint32_t row = 0; row < static_cast<std::uint32_t>(cells.y); ++row)
        for (std::uint32_t column = 0; column + 1 < width; ++column) {
            const std::uint32_t a = row * width + column;
            triangles.emplace_back(a, a + width, a + width + 1);
            triangles.emplace_back(a, a + width + 1, a + 1);
        }
    return triangles;
}

} // namespace

void shapeTable(EyeMesh& table, glm::vec2 size, glm::ivec2 cells) {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec2> coordinates;
    for (int row = 0; row <= cells.y; ++row)
        for (int column = 0; column <= cells.x; ++column) {
            const glm::vec2 at = size * (glm::vec2(column, row) / glm::vec2(cells) - 0.5F);
            positions.emplace_back(at.x, 0.0F, at.y);
            coordinates.push_back(at);
        }
    table.setTopology(gridTriangles(cells), coordinates);
    table.setShape(positions, std::vector<glm::vec3>(positions.size(), glm::vec3(0.0F, 1.0F, 0.0F)));
}

} // namespace lumorph
