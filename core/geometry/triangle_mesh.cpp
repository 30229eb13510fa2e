#include "core/geometry/triangle_mesh.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace lumorph {

void Box::include(const glm::vec3& point) noexcept {
    if (empty()) {
        min = max = point;
        return;
    }
    min = glm::min(min, point);
    max = glm::max(max, point);
}

void Box::include(const Box& other) noexcept {
    if (other.empty()) return;
    include(other.min);
    include(other.max);
}

Box boundingBox(std::span<const glm::vec3> points) noexcept {
    Box box;
    for (const glm::vec3& point : points) box.include(point);
    return box;
}

std::array<glm::vec3, 8> cornersOf(const Box& box, const glm::mat4& frameFromBox) noexcept {
    std::array<glm::vec3, 8> corners{};
    for (std::size_t i = 0; i < corners.size(); ++i)
        corners[i] = glm::vec3(frameFromBox * glm::vec4((i & 1U) != 0 ? box.max.x : box.min.x,
                                                        (i & 2U) != 0 ? box.max.y : box.min.y,
                                                        (i & 4U) != 0 ? box.max.z : box.min.z, 1.0F));
    return corners;
}

double signedVolume(const TriangleMesh& mesh) noexcept {
    double sum = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]);
        const glm::dvec3 b(mesh.positions[t.y]);
        const glm::dvec3 c(mesh.positions[t.z]);
        sum += glm::dot(a, glm::cross(b, c));
    }
    return sum / 6.0;
}

void append(TriangleMesh& mesh, const TriangleMesh& other) {
    const auto offset = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    mesh.triangles.reserve(mesh.triangles.size() + other.triangles.size());
    for (const glm::uvec3& t : other.triangles) mesh.triangles.push_back(t + glm::uvec3(offset));
}

} // namespace lumorph
