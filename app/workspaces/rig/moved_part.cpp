#include "app/workspaces/rig/moved_part.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>

#include <glm/geometric.hpp>

namespace lumorph::studio {

namespace {

// More lines than this would hide what they are about, and hold up the window.
constexpr std::size_t kMostEdges = 4000;
constexpr double kWiggleSeconds = 1.2;
constexpr int kWiggles = 2;

/// One triangle's side of an edge.
struct Side {
    std::uint64_t edge = 0; ///< both vertices, the smaller one first
    glm::vec3 normal{0.0F};
    bool moved = false;
};

std::uint64_t edgeOf(std::uint32_t a, std::uint32_t b) {
    return static_cast<std::uint64_t>(std::min(a, b)) << 32U | std::max(a, b);
}

/// Of the triangles at an edge: some are moved, and it is where the part ends or is creased.
bool isBorder(std::span<const Side> sides) {
    const auto moved = std::ranges::count_if(sides, &Side::moved);
    bool creased = false;
    for (std::size_t i = 1; i < sides.size(); ++i)
        creased = creased || glm::dot(sides[i - 1].normal, sides[i].normal) < 0.8F;
    return moved > 0 && (moved < static_cast<std::ptrdiff_t>(sides.size()) || moved == 1 || creased);
}

} // namespace

MovedPart::MovedPart(const Rig& rig, std::size_t actuator) {
    const TriangleMesh& mesh = rig.restMesh();
    std::vector<bool> moves(mesh.positions.size(), false), near(mesh.positions.size(), false);
    for (const std::uint32_t vertex : rig.verticesOf(actuator)) moves[vertex] = true;
    const auto isMoved = [&](const glm::uvec3& t) { return moves[t.x] || moves[t.y] || moves[t.z]; };
    for (const glm::uvec3& t : mesh.triangles)
        if (isMoved(t)) near[t.x] = near[t.y] = near[t.z] = true;
    std::vector<Side> sides; // of triangles that touch the part
    for (const glm::uvec3& t : mesh.triangles) {
        if (!near[t.x] && !near[t.y] && !near[t.z]) continue;
        const glm::vec3 across =
            glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]);
        const glm::vec3 normal = glm::length(across) > 0.0F ? glm::normalize(across) : glm::vec3(0.0F);
        for (int k = 0; k < 3; ++k) sides.push_back({edgeOf(t[k], t[(k + 1) % 3]), normal, isMoved(t)});
    }
    std::ranges::sort(sides, {}, &Side::edge);
    for (auto first = sides.begin(); first != sides.end() && edges_.size() < kMostEdges;) {
        const auto last = std::find_if(first, sides.end(), [&](const Side& side) { return side.edge != first->edge; });
        if (isBorder({first, last}))
            edges_.emplace_back(static_cast<std::uint32_t>(first->edge >> 32U),
                                static_cast<std::uint32_t>(first->edge));
        first = last;
    }
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
