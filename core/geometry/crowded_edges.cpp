#include "core/geometry/crowded_edges.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace lumorph {
namespace {

/// A triangle at an edge: where it lies around the edge, and which way its half-edge runs.
struct Leaf {
    double angle;
    bool forward;
    std::uint32_t halfEdge;
};

std::vector<Leaf> leavesAround(const TriangleMesh& mesh, const MeshTopology& topology,
                               const std::vector<std::uint32_t>& edge) {
    const auto position = [&](std::uint32_t corner) { return glm::dvec3(mesh.positions[vertexAt(mesh, corner)]); };
    const std::uint32_t from = topology.startPlace(mesh, edge.front());
    const glm::dvec3 origin = position(edge.front());
    const glm::dvec3 axis = glm::normalize(position(nextInTriangle(edge.front())) - origin);
    const glm::dvec3 helper = std::abs(axis.x) < 0.9 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
    const glm::dvec3 u = glm::normalize(glm::cross(axis, helper));
    const glm::dvec3 v = glm::cross(axis, u);
    std::vector<Leaf> leaves;
    for (const std::uint32_t h : edge) {
        const glm::dvec3 tip = position(nextInTriangle(nextInTriangle(h))) - origin;
        leaves.push_back({std::atan2(glm::dot(tip, v), glm::dot(tip, u)), topology.startPlace(mesh, h) == from, h});
    }
    std::ranges::sort(leaves, {}, &Leaf::angle);
    return leaves;
}

/// Leaves alternate and none lie on each other.
bool decided(const std::vector<Leaf>& leaves) {
    constexpr double kLeastTurn = 1e-7; // radians; what the rounding of float coordinates can tell apart
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        const Leaf& next = leaves[(i + 1) % leaves.size()];
        const double turn = next.angle - leaves[i].angle + (i + 1 == leaves.size() ? 2.0 * M_PI : 0.0);
        if (leaves[i].forward == next.forward || !(turn > kLeastTurn)) return false;
    }
    return leaves.size() % 2 == 0;
}

} // namespace

void joinCrowdedEdges(const TriangleMesh& mesh, MeshTopology& topology) {
    for (const std::vector<std::uint32_t>& edge : topology.crowdedEdges) {
        const std::vector<Leaf> leaves = leavesAround(mesh, topology, edge);
        if (!decided(leaves)) continue;
        for (std::size_t i = 0; i < leaves.size(); ++i) {
            // A forward triangle faces the way angles grow; its solid is on the other side.
            if (!leaves[i].forward) continue;
            const Leaf& across = leaves[(i + leaves.size() - 1) % leaves.size()];
            topology.partner[leaves[i].halfEdge] = across.halfEdge;
            topology.partner[across.halfEdge] = leaves[i].halfEdge;
        }
    }
}

} // namespace lumorph
