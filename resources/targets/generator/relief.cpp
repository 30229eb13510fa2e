#include "resources/targets/generator/relief.h"

#include <cmath>
#include <cstdint>

namespace lumorph {

namespace {

float rounded(double metres) { return static_cast<float>(std::round(metres * 1e5) / 1e5); }

std::uint32_t topVertex(const Relief& relief, int i, int j) {
    return static_cast<std::uint32_t>(j * (relief.columns + 1) + i);
}

/// The border of the top, counter-clockwise seen from above.
std::vector<std::uint32_t> borderOf(const Relief& relief) {
    std::vector<std::uint32_t> border;
    border.reserve(2 * static_cast<std::size_t>(relief.columns + relief.rows));
    for (int i = 0; i < relief.columns; ++i) border.push_back(topVertex(relief, i, relief.rows));
    for (int j = relief.rows; j > 0; --j) border.push_back(topVertex(relief, relief.columns, j));
    for (int i = relief.columns; i > 0; --i) border.push_back(topVertex(relief, i, 0));
    for (int j = 0; j < relief.rows; ++j) border.push_back(topVertex(relief, 0, j));
    return border;
}

void addTop(const Relief& relief, const Height& height, TriangleMesh& mesh) {
    for (int j = 0; j <= relief.rows; ++j)
        for (int i = 0; i <= relief.columns; ++i) {
            const double x = static_cast<double>(relief.width) * (static_cast<double>(i) / relief.columns - 0.5);
            const double z = static_cast<double>(relief.depth) * (static_cast<double>(j) / relief.rows - 0.5);
            mesh.positions.emplace_back(rounded(x), rounded(height(x, z)), rounded(z));
        }
    for (int j = 0; j < relief.rows; ++j)
        for (int i = 0; i < relief.columns; ++i) {
            const std::uint32_t a = topVertex(relief, i, j);
            const std::uint32_t b = topVertex(relief, i, j + 1);
            const std::uint32_t c = topVertex(relief, i + 1, j + 1);
            const std::uint32_t d = topVertex(relief, i + 1, j);
            mesh.triangles.emplace_back(a, b, c);
            mesh.triangles.emplace_back(a, c, d);
        }
}

void addWallsAndBase(const Relief& relief, TriangleMesh& mesh) {
    const std::vector<std::uint32_t> border = borderOf(relief);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const auto count = static_cast<std::uint32_t>(border.size());
    for (const std::uint32_t top : border) {
        const glm::vec3 above = mesh.positions[top];
        mesh.positions.emplace_back(above.x, 0.0F, above.z);
    }
    const auto centre = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.emplace_back(0.0F);
    for (std::uint32_t k = 0; k < count; ++k) {
        const std::uint32_t next = (k + 1) % count;
        mesh.triangles.emplace_back(border[k], first + k, first + next);
        mesh.triangles.emplace_back(border[k], first + next, border[next]);
        mesh.triangles.emplace_back(centre, first + next, first + k);
    }
}

} // namespace

TriangleMesh reliefMesh(const Relief& relief, const Height& height) {
    TriangleMesh mesh;
    addTop(relief, height, mesh);
    addWallsAndBase(relief, mesh);
    return mesh;
}

std::vector<glm::vec3> reliefDisplacement(const Relief& relief, const TriangleMesh& mesh, const Height& height) {
    std::vector<glm::vec3> displacement(mesh.positions.size(), glm::vec3(0.0F));
    const std::size_t top = static_cast<std::size_t>(relief.columns + 1) * static_cast<std::size_t>(relief.rows + 1);
    for (std::size_t v = 0; v < top; ++v) {
        const glm::dvec3 at(mesh.positions[v]);
        displacement[v].y = rounded(height(at.x, at.z));
    }
    return displacement;
}

} // namespace lumorph
