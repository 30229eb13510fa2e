#pragma once

#include <optional>
#include <vector>

#include <glm/vec2.hpp>

/// Convex polygons seen from above: x and z in metres, corners counterclockwise where x points right and z up. All ice
/// is made of them.
namespace lumorph::ice {

using Polygon = std::vector<glm::dvec2>;

/// A straight line from one place to another.
struct Segment {
    glm::dvec2 from{0.0};
    glm::dvec2 to{0.0};
};

/// The side of a straight line on which `dot(normal, place) <= offset`; the normal has length 1.
struct HalfPlane {
    glm::dvec2 normal{1.0, 0.0};
    double offset = 0.0;
};

/// How a piece of the pond lies now: home coordinates are those in which it froze.
struct Placement {
    glm::dvec2 shift{0.0};
    double turn = 0.0; ///< radians, from x to z
};
[[nodiscard]] glm::dvec2 placed(const Placement& placement, const glm::dvec2& home) noexcept;
[[nodiscard]] glm::dvec2 homeOf(const Placement& placement, const glm::dvec2& place) noexcept;

[[nodiscard]] double cross(const glm::dvec2& a, const glm::dvec2& b) noexcept;

/// Square metres; 0 for fewer than three corners.
[[nodiscard]] double areaOf(const Polygon& polygon) noexcept;
/// Of its area; the mean of its corners where it has none.
[[nodiscard]] glm::dvec2 centreOf(const Polygon& polygon) noexcept;
/// Whether a place lies in it or on its rim.
[[nodiscard]] bool holds(const Polygon& polygon, const glm::dvec2& place) noexcept;
/// The place of its rim that is nearest; of a polygon with corners.
[[nodiscard]] glm::dvec2 nearestOnRim(const Polygon& polygon, const glm::dvec2& place) noexcept;

/// What of it lies in the half-plane; empty where that is nothing.
[[nodiscard]] Polygon clipped(const Polygon& polygon, const HalfPlane& half);
/// The half-plane that lies left of an edge, moved inwards by `inset` metres.
[[nodiscard]] HalfPlane insideOf(const glm::dvec2& from, const glm::dvec2& to, double inset) noexcept;

/// Where two polygons touch along their edges: the longest common piece of an edge of each, within a micrometre.
[[nodiscard]] std::optional<Segment> sharedEdge(const Polygon& a, const Polygon& b) noexcept;

[[nodiscard]] double lengthOf(const Segment& segment) noexcept;
[[nodiscard]] double distanceTo(const Segment& segment, const glm::dvec2& place) noexcept;

} // namespace lumorph::ice
