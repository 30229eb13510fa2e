#include "core/geometry/polygon_triangulation.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace lumorph {
namespace {

/// Twice the signed area of a triangle; positive counter-clockwise.
double doubleArea(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) noexcept {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Newell's normal: right for dented and slightly bent polygons too; its length is twice the area.
glm::dvec3 newellNormal(std::span<const glm::vec3> positions, std::span<const std::uint32_t> corners) noexcept {
    const glm::dvec3 origin(positions[corners[0]]);
    glm::dvec3 normal(0.0);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        normal +=
            glm::cross(glm::dvec3(positions[corners[i]]) - origin, glm::dvec3(positions[corners[i + 1]]) - origin);
    return normal;
}

/// The corners in the polygon's plane, counter-clockwise, relative to the first.
std::vector<glm::dvec2> projected(std::span<const glm::vec3> positions, std::span<const std::uint32_t> corners,
                                  const glm::dvec3& normal) {
    const glm::dvec3 helper =
        std::abs(normal.x) < 0.9 * glm::length(normal) ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
    const glm::dvec3 u = glm::normalize(glm::cross(helper, normal));
    const glm::dvec3 v = glm::cross(glm::normalize(normal), u);
    std::vector<glm::dvec2> points;
    points.reserve(corners.size());
    const glm::dvec3 origin(positions[corners[0]]);
    for (const std::uint32_t corner : corners) {
        const glm::dvec3 offset = glm::dvec3(positions[corner]) - origin;
        points.emplace_back(glm::dot(offset, u), glm::dot(offset, v));
    }
    return points;
}

/// Cuts off one ear after the other. Corners still there form a ring of `next_` and `previous_`.
class EarClipper {
public:
    EarClipper(std::span<const std::uint32_t> corners, std::vector<glm::dvec2> points, double tolerance)
        : corners_(corners), points_(std::move(points)), tolerance_(tolerance), next_(corners.size()),
          previous_(corners.size()) {
        const std::size_t count = corners.size();
        for (std::size_t i = 0; i < count; ++i) {
            next_[i] = (i + 1) % count;
            previous_[i] = (i + count - 1) % count;
        }
    }

    /// A convex polygon without corners on a straight side: any fan is right. One whose corners all
    /// turn left may still wind round twice; the caller compares the area.
    [[nodiscard]] bool strictlyConvex() const noexcept {
        for (std::size_t i = 0; i < points_.size(); ++i)
            if (area(i) <= tolerance_ || doubleArea(points_[0], points_[i], points_[next_[i]]) < 0.0) return false;
        return true;
    }

    void clip(std::vector<glm::uvec3>& triangles) {
        std::size_t left = corners_.size();
        std::size_t corner = 0;
        std::size_t tried = 0;
        while (left > 3) {
            const bool stuck = tried >= left;
            if (stuck) corner = largestCorner(corner, left);
            if (stuck || isEar(corner, left)) {
                emit(corner, triangles);
                next_[previous_[corner]] = next_[corner];
                previous_[next_[corner]] = previous_[corner];
                --left;
                tried = 0;
                // Moving on by one corner keeps the triangles from becoming one long fan.
                corner = next_[next_[corner]];
            } else {
                corner = next_[corner];
                ++tried;
            }
        }
        emit(corner, triangles);
    }

private:
    [[nodiscard]] double area(std::size_t i) const noexcept {
        return doubleArea(points_[previous_[i]], points_[i], points_[next_[i]]);
    }

    [[nodiscard]] bool isEar(std::size_t i, std::size_t left) const noexcept {
        if (area(i) <= tolerance_) return false;
        const glm::dvec2& a = points_[previous_[i]];
        const glm::dvec2& b = points_[i];
        const glm::dvec2& c = points_[next_[i]];
        std::size_t other = next_[next_[i]];
        for (std::size_t k = 3; k < left; ++k, other = next_[other]) {
            const glm::dvec2& p = points_[other];
            // A bridge to an inner ring passes twice through the same place.
            if (p == a || p == b || p == c) continue;
            // Also a corner on the ear's rim forbids it: cutting there would leave a flat triangle.
            if (doubleArea(a, b, p) >= -tolerance_ && doubleArea(b, c, p) >= -tolerance_ &&
                doubleArea(c, a, p) >= -tolerance_)
                return false;
        }
        return true;
    }

    /// The way out of a polygon that crosses itself.
    [[nodiscard]] std::size_t largestCorner(std::size_t start, std::size_t left) const noexcept {
        std::size_t best = start;
        for (std::size_t k = 0; k < left; ++k, start = next_[start])
            if (area(start) > area(best)) best = start;
        return best;
    }

    void emit(std::size_t i, std::vector<glm::uvec3>& triangles) const {
        triangles.emplace_back(corners_[previous_[i]], corners_[i], corners_[next_[i]]);
    }

    std::span<const std::uint32_t> corners_;
    std::vector<glm::dvec2> points_;
    double tolerance_;
    std::vector<std::size_t> next_;
    std::vector<std::size_t> previous_;
};

void fan(std::span<const std::uint32_t> corners, std::vector<glm::uvec3>& triangles) {
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) triangles.emplace_back(corners[0], corners[i], corners[i + 1]);
}

} // namespace

void triangulatePolygon(std::span<const glm::vec3> positions, std::span<const std::uint32_t> corners,
                        std::vector<glm::uvec3>& triangles) {
    if (corners.size() <= 3) return fan(corners, triangles);
    const glm::dvec3 normal = newellNormal(positions, corners);
    const double size = glm::length(normal);
    // Nothing to see in a polygon without area; checks of the mesh will report its flat triangles.
    if (!(size > 0.0) || !std::isfinite(size)) return fan(corners, triangles);
    EarClipper clipper(corners, projected(positions, corners, normal), 1e-9 * size);
    if (clipper.strictlyConvex())
        fan(corners, triangles);
    else
        clipper.clip(triangles);
}

} // namespace lumorph
