#pragma once

#include <vector>

#include <glm/vec2.hpp>

/// Lines and outlines in the plane of a map: x to the east, y to the south.
namespace lumorph::navigation {

/// A smooth line through some points (Catmull-Rom), its points at most `step` apart.
[[nodiscard]] std::vector<glm::dvec2> smoothLine(const std::vector<glm::dvec2>& through, double step);

/// Where a line comes nearest to a place.
struct Nearest {
    double distance = 0.0; ///< metres
    double along = 0.0;    ///< share of the line's points passed, 0 to 1
};
[[nodiscard]] Nearest nearestOn(const std::vector<glm::dvec2>& line, const glm::dvec2& place) noexcept;

/// Of a segment.
[[nodiscard]] double distanceTo(const glm::dvec2& from, const glm::dvec2& to, const glm::dvec2& place) noexcept;

/// A rectangle about a centre whose first side runs along `along` (length 1); clockwise seen from above.
[[nodiscard]] std::vector<glm::dvec2> rectangle(const glm::dvec2& centre, const glm::dvec2& along, double length,
                                                double depth);

/// A regular polygon; clockwise seen from above.
[[nodiscard]] std::vector<glm::dvec2> roundOutline(const glm::dvec2& centre, double radius, int corners);

/// Whether two convex outlines have some ground in common (separating axes).
[[nodiscard]] bool overlap(const std::vector<glm::dvec2>& a, const std::vector<glm::dvec2>& b) noexcept;

/// An outline and its holes as one ring, joined by bridges that are passed twice (for `triangulatePolygon`).
[[nodiscard]] std::vector<glm::dvec2> bridged(std::vector<glm::dvec2> outline,
                                              std::vector<std::vector<glm::dvec2>> holes);

/// Convex pieces, clockwise seen from above, that together cover an outline without its holes.
[[nodiscard]] std::vector<std::vector<glm::dvec2>> convexParts(const std::vector<glm::dvec2>& outline,
                                                               const std::vector<std::vector<glm::dvec2>>& holes);
[[nodiscard]] bool isConvex(const std::vector<glm::dvec2>& outline) noexcept; ///< one that runs clockwise

/// Twice the area, positive for clockwise seen from above.
[[nodiscard]] double doubleArea(const std::vector<glm::dvec2>& outline) noexcept;

[[nodiscard]] double smoothStep(double from, double to, double value) noexcept;

} // namespace lumorph::navigation
