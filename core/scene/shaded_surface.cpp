#include <algorithm>

#include <glm/geometric.hpp>

#include "core/scene/item_surfaces.h"

namespace lumorph {
namespace {

constexpr Angle kCrease = Angle::degrees(35.0);

} // namespace

ShadedSurface::ShadedSurface(const TriangleMesh& mesh, std::span<const glm::vec2> coordinates)
    : shading_(std::make_shared<const SurfaceShading>(mesh, kCrease)) {
    SurfaceTopology topology;
    const std::span<const glm::uvec3> triangles = shading_->triangles();
    topology.triangles.assign(triangles.begin(), triangles.end());
    for (const std::uint32_t source : shading_->sources())
        topology.coordinates.push_back(source < coordinates.size() ? coordinates[source] : glm::vec2(0.0F));
    topology_ = std::make_shared<const SurfaceTopology>(std::move(topology));
}

ItemSurface ShadedSurface::at(std::span<const glm::vec3> positions) const {
    std::vector<ShadedMesh::Vertex> vertices(topology_->coordinates.size());
    shading_->shade(positions, vertices);
    auto points = std::make_shared<std::vector<glm::vec3>>(vertices.size());
    auto normals = std::make_shared<std::vector<glm::vec3>>(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        (*points)[i] = vertices[i].position;
        const glm::vec3& normal = vertices[i].normal;
        (*normals)[i] = glm::dot(normal, normal) > 0.25F ? normal : glm::vec3(0.0F, 1.0F, 0.0F);
    }
    return {topology_, std::move(points), std::move(normals)};
}

} // namespace lumorph
