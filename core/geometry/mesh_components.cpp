#include "core/geometry/mesh_topology.h"

#include <algorithm>
#include <array>

#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "core/geometry/disjoint_sets.h"

namespace lumorph {
namespace {

struct Point2 {
    double y;
    double z;
};

/// Twice the signed area of (a, b, origin). Computed from the lower point, whichever way round, so
/// that two triangles see exactly the same number (but for the sign) at the edge they share.
double edgeSide(const Point2& a, const Point2& b) noexcept {
    const bool swapped = b.y < a.y || (b.y == a.y && b.z < a.z);
    const Point2& low = swapped ? b : a;
    const Point2& high = swapped ? a : b;
    const double side = low.y * high.z - low.z * high.y;
    return swapped ? -side : side;
}

/// How often the edge from a to b crosses the half-line z > 0 at y = 0 (right to left counts 1): the
/// half-open rule sees a chain of edges through a vertex once.
int crossing(const Point2& a, const Point2& b) noexcept {
    if ((a.y <= 0.0) == (b.y <= 0.0)) return 0;
    const bool leftwards = a.y > 0.0;
    const double side = edgeSide(a, b);
    // The edge passes above the origin when the origin is to its left on the way left.
    if (leftwards) return side > 0.0 ? 1 : 0;
    return side < 0.0 ? -1 : 0;
}

} // namespace

std::vector<MeshComponent> meshComponents(const TriangleMesh& mesh, const MeshTopology& topology) {
    const auto triangleCount = static_cast<std::uint32_t>(mesh.triangles.size());
    DisjointSets sets(triangleCount);
    for (std::uint32_t h = 0; h < topology.partner.size(); ++h)
        if (topology.partner[h] != MeshTopology::kNone) sets.join(h / 3, topology.partner[h] / 3);
    for (const std::vector<std::uint32_t>& edge : topology.crowdedEdges)
        for (const std::uint32_t h : edge) sets.join(h / 3, edge.front() / 3);

    std::vector<MeshComponent> components;
    std::vector<std::uint32_t> numberOf(triangleCount, MeshTopology::kNone);
    for (std::uint32_t t = 0; t < triangleCount; ++t) {
        if (topology.ignored[t]) continue;
        const std::uint32_t root = sets.find(t);
        if (numberOf[root] == MeshTopology::kNone) {
            numberOf[root] = static_cast<std::uint32_t>(components.size());
            components.emplace_back();
        }
        numberOf[t] = numberOf[root];
        MeshComponent& component = components[numberOf[t]];
        component.triangles.push_back(t);
        const glm::uvec3& corners = mesh.triangles[t];
        const std::array points{mesh.positions[corners.x], mesh.positions[corners.y], mesh.positions[corners.z]};
        for (const glm::vec3& point : points) component.box.include(point);
        component.volume +=
            glm::dot(glm::dvec3(points[0]), glm::cross(glm::dvec3(points[1]), glm::dvec3(points[2]))) / 6.0;
        for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h)
            if (const std::uint32_t other = topology.partner[h]; other != MeshTopology::kNone)
                component.coherent &= topology.startPlace(mesh, h) != topology.startPlace(mesh, other);
    }
    for (const std::uint32_t h : topology.boundary) components[numberOf[h / 3]].closed = false;
    return components;
}

int windingNumber(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles, const glm::vec3& point) noexcept {
    // A ray along +x from the point: each triangle whose shadow on the yz plane holds the point and
    // that lies in front of it adds the turn its shadow makes.
    int winding = 0;
    const glm::dvec3 origin(point);
    for (const std::uint32_t t : triangles) {
        const glm::uvec3& corners = mesh.triangles[t];
        const glm::dvec3 a = glm::dvec3(mesh.positions[corners.x]) - origin;
        const glm::dvec3 b = glm::dvec3(mesh.positions[corners.y]) - origin;
        const glm::dvec3 c = glm::dvec3(mesh.positions[corners.z]) - origin;
        if ((a.x < 0.0 && b.x < 0.0 && c.x < 0.0) || std::min({a.y, b.y, c.y}) > 0.0 || std::max({a.y, b.y, c.y}) < 0.0)
            continue;
        const Point2 pa{a.y, a.z};
        const Point2 pb{b.y, b.z};
        const Point2 pc{c.y, c.z};
        const int turn = crossing(pa, pb) + crossing(pb, pc) + crossing(pc, pa);
        if (turn == 0) continue;
        // Where the ray meets the triangle's plane, x times the normal's x is this dot product.
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        if (glm::dot(normal, a) * normal.x > 0.0) winding += turn;
    }
    return winding;
}

int nesting(const TriangleMesh& mesh, const MeshComponent& inner, const MeshComponent& outer) noexcept {
    if (!glm::all(glm::lessThan(inner.box.min, outer.box.max)) ||
        !glm::all(glm::lessThan(outer.box.min, inner.box.max)))
        return 0;
    // Three points, as one may happen to lie on the outer surface.
    std::array<int, 3> turns{};
    for (std::size_t i = 0; i < turns.size(); ++i) {
        const glm::uvec3& corners = mesh.triangles[inner.triangles[i * (inner.triangles.size() - 1) / 2]];
        const glm::vec3 middle =
            (mesh.positions[corners.x] + mesh.positions[corners.y] + mesh.positions[corners.z]) / 3.0F;
        if (glm::all(glm::lessThanEqual(outer.box.min, middle)) && glm::all(glm::lessThanEqual(middle, outer.box.max)))
            turns[i] = windingNumber(mesh, outer.triangles, middle);
    }
    std::ranges::sort(turns);
    return turns[1];
}

std::vector<std::size_t> inwardComponents(const TriangleMesh& mesh, std::span<const MeshComponent> components) {
    std::vector<const MeshComponent*> outward;
    for (const MeshComponent& component : components)
        if (component.closed && component.coherent && component.volume > 0.0) outward.push_back(&component);
    std::vector<std::size_t> inward;
    for (std::size_t i = 0; i < components.size(); ++i) {
        const MeshComponent& piece = components[i];
        if (!piece.closed || !piece.coherent || !(piece.volume < 0.0)) continue;
        const bool cavity =
            std::ranges::any_of(outward, [&](const MeshComponent* outer) { return nesting(mesh, piece, *outer) > 0; });
        if (!cavity) inward.push_back(i);
    }
    return inward;
}

} // namespace lumorph
