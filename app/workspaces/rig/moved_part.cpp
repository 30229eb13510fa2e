#include "app/workspaces/rig/moved_part.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

namespace lumorph::studio {

namespace {

// More lines than this would hide what they are about, and hold up the window.
constexpr std::size_t kMostEdges = 4000;
constexpr double kWiggleSeconds = 1.2;
constexpr int kWiggles = 2;

/// What lies on the two sides of an edge.
struct Sides {
    int moved = 0;
    int still = 0;
    glm::vec3 normal{0.0F};
    bool creased = false;
};

} // namespace

MovedPart::MovedPart(const Rig& rig, std::size_t actuator) {
    const TriangleMesh& mesh = rig.restMesh();
    std::vector<bool> moves(mesh.positions.size(), false);
    for (const std::uint32_t vertex : rig.verticesOf(actuator)) moves[vertex] = true;
    std::map<std::pair<std::uint32_t, std::uint32_t>, Sides> edges;
    for (const glm::uvec3& t : mesh.triangles) {
        const bool moved = moves[t.x] || moves[t.y] || moves[t.z];
        const glm::vec3 across =
            glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]);
        const glm::vec3 normal = glm::length(across) > 0.0F ? glm::normalize(across) : glm::vec3(0.0F);
        for (int k = 0; k < 3; ++k) {
            Sides& sides = edges[std::minmax(t[k], t[(k + 1) % 3])];
            sides.creased = sides.creased || (sides.moved > 0 && glm::dot(sides.normal, normal) < 0.8F);
            sides.normal = normal;
            ++(moved ? sides.moved : sides.still);
        }
    }
    for (const auto& [edge, sides] : edges)
        if (sides.moved > 0 && (sides.still > 0 || sides.moved == 1 || sides.creased) && edges_.size() < kMostEdges)
            edges_.emplace_back(edge.first, edge.second);
}

std::vector<ViewportLine> MovedPart::lines(const std::vector<glm::vec3>& positions, const glm::vec3& color) const {
    std::vector<ViewportLine> lines;
    lines.reserve(edges_.size());
    for (const glm::uvec2& edge : edges_)
        if (std::max(edge.x, edge.y) < positions.size())
            lines.push_back({positions[edge.x], positions[edge.y], color, 2.0F, false});
    return lines;
}

double wiggleStroke(double seconds) {
    if (!(seconds >= 0.0) || seconds >= kWiggles * kWiggleSeconds) return -1.0;
    return 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * seconds / kWiggleSeconds);
}

} // namespace lumorph::studio
