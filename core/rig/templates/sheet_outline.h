#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

namespace lumorph {

/// Outlines of sheets: polygons of points (x, z) in metres around the origin, z towards the viewer.

[[nodiscard]] std::vector<glm::dvec2> rectangleOutline(double width, double depth, double cornerRadius = 0.0);
/// Within 0.1 mm of the ellipse.
[[nodiscard]] std::vector<glm::dvec2> ellipseOutline(double width, double depth);

/// The box around points; of none it is the origin.
struct OutlineBox {
    glm::dvec2 low{0.0};
    glm::dvec2 high{0.0};
    [[nodiscard]] glm::dvec2 size() const noexcept { return high - low; }
    [[nodiscard]] glm::dvec2 middle() const noexcept { return 0.5 * (low + high); }
};
[[nodiscard]] OutlineBox boxOf(const std::vector<glm::dvec2>& outline) noexcept;

/// The outline without points that add nothing. Throws InvalidInput naming `subject` unless it is a simple polygon of
/// finite points, 2 cm to 2 m wide and deep.
[[nodiscard]] std::vector<glm::dvec2> checkedOutline(const std::vector<glm::dvec2>& outline,
                                                     const std::string& subject);

/// The smallest convex polygon that holds the points, counter-clockwise where y is up; without points on its sides.
[[nodiscard]] std::vector<glm::dvec2> convexHull(std::vector<glm::dvec2> points);

/// That polygon with every side `margin` farther out; sharp corners are cut off at the same distance.
[[nodiscard]] std::vector<glm::dvec2> grownHull(const std::vector<glm::dvec2>& points, double margin);

/// The one closed shape of an SVG drawing: rect, circle, ellipse, polygon, or path (all its commands, implicitly closed
/// as where it is filled), under the transforms of its groups; x to the right and z down the page in metres from the
/// page's upper left corner. Lengths without a unit are CSS pixels of 1/96 inch. Lines and what has no area are no
/// outlines; text, pictures and what stands in `defs` is passed over.
/// Throws DataError naming the drawing when it is no SVG, holds no such shape or several, or one with several parts.
[[nodiscard]] std::vector<glm::dvec2> svgOutline(std::string_view svg, const std::string& name);

} // namespace lumorph
