#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

#include "core/geometry/plane_mesh.h"

namespace lumorph {

/// An edge of a drawing in the plane: two indices of points.
using PlaneEdge = std::pair<std::uint32_t, std::uint32_t>;

/// Points on the page in millimetres, one for places that are all but the same, and the lines between them.
class PlaneDrawing {
public:
    static constexpr double kSnap = 0.03; ///< points nearer than this become one

    std::uint32_t add(const glm::dvec2& p);
    void addEdge(const glm::dvec2& from, const glm::dvec2& to) { edges_.emplace_back(add(from), add(to)); }
    /// Points at most `spacing` apart on the way from one to the other.
    void addLine(const glm::dvec2& from, const glm::dvec2& to, double spacing);

    /// Lines may cross; one that passes a point closely goes through it.
    [[nodiscard]] PlaneMesh triangulate() const;

private:
    void splitAtPoints(std::uint32_t a, std::uint32_t b, std::vector<PlaneEdge>& edges) const;

    std::vector<glm::dvec2> points_;
    std::vector<PlaneEdge> edges_;
    std::map<std::pair<int, int>, std::vector<std::uint32_t>> cells_;
};

} // namespace lumorph
