#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace lumorph {

/// A constrained Delaunay triangulation of the points; the triangles, counter-clockwise, whose
/// centroid `keep` accepts. Edges must not cross. Uses exact predicates: the same on every machine.
[[nodiscard]] std::vector<glm::uvec3>
triangulatePlane(const std::vector<glm::dvec2>& points,
                 const std::vector<std::pair<std::uint32_t, std::uint32_t>>& edges,
                 const std::function<bool(const glm::dvec2&)>& keep);

struct PlaneMesh {
    std::vector<glm::dvec2> points;    ///< those given, in their order, and where edges cross
    std::vector<glm::uvec3> triangles; ///< of the points' convex hull, counter-clockwise
};

/// The same for edges that may cross or overlap.
[[nodiscard]] PlaneMesh triangulateCrossing(const std::vector<glm::dvec2>& points,
                                            const std::vector<std::pair<std::uint32_t, std::uint32_t>>& edges);

/// Adds the triangles of a wall between two columns of vertices, each from the foot up.
void addWall(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b,
             std::vector<glm::uvec3>& triangles);

/// The cross product of two ways in the plane: positive where the second turns left of the first.
[[nodiscard]] inline double crossOf(const glm::dvec2& a, const glm::dvec2& b) noexcept { return a.x * b.y - a.y * b.x; }

/// Positive for a polygon that runs counter-clockwise.
[[nodiscard]] double signedArea(const std::vector<glm::dvec2>& polygon) noexcept;

/// True inside the polygon (even-odd).
[[nodiscard]] bool insidePolygon(const std::vector<glm::dvec2>& polygon, const glm::dvec2& point);

} // namespace lumorph
