#include "app/applications/navigation/shapes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "core/geometry/polygon_triangulation.h"

namespace lumorph::navigation {
namespace {

glm::dvec2 between(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d, double t) {
    return 0.5 *
           (2.0 * b + t * (c - a) + t * t * (2.0 * a - 5.0 * b + 4.0 * c - d) + t * t * t * (3.0 * (b - c) + d - a));
}

bool apart(const std::vector<glm::dvec2>& a, const std::vector<glm::dvec2>& b) noexcept {
    for (std::size_t k = 0; k < a.size(); ++k) {
        const glm::dvec2 side = a[(k + 1) % a.size()] - a[k];
        const glm::dvec2 outward(side.y, -side.x);
        double most = -std::numeric_limits<double>::infinity(), least = std::numeric_limits<double>::infinity();
        for (const glm::dvec2& corner : a) most = std::max(most, glm::dot(corner, outward));
        for (const glm::dvec2& corner : b) least = std::min(least, glm::dot(corner, outward));
        if (least >= most) return true;
    }
    return false;
}

double turnAt(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

/// Whether a ring crosses a line, or touches it anywhere but in its ends.
bool crosses(const std::vector<glm::dvec2>& ring, const glm::dvec2& from, const glm::dvec2& to) {
    for (std::size_t k = 0; k < ring.size(); ++k) {
        const glm::dvec2 &a = ring[k], &b = ring[(k + 1) % ring.size()];
        if (a == from || a == to || b == from || b == to) continue;
        if (turnAt(from, to, a) * turnAt(from, to, b) <= 0.0 && turnAt(a, b, from) * turnAt(a, b, to) <= 0.0)
            return true;
    }
    return false;
}

} // namespace

std::vector<glm::dvec2> smoothLine(const std::vector<glm::dvec2>& through, double step) {
    std::vector<glm::dvec2> line;
    for (std::size_t k = 0; k + 1 < through.size(); ++k) {
        const glm::dvec2 &b = through[k], &c = through[k + 1];
        const glm::dvec2 a = k == 0 ? 2.0 * b - c : through[k - 1];
        const glm::dvec2 d = k + 2 < through.size() ? through[k + 2] : 2.0 * c - b;
        const int pieces = std::max(1, static_cast<int>(std::ceil(1.2 * glm::distance(b, c) / step)));
        for (int p = 0; p < pieces; ++p) line.push_back(between(a, b, c, d, static_cast<double>(p) / pieces));
    }
    if (!through.empty()) line.push_back(through.back());
    return line;
}

double distanceTo(const glm::dvec2& from, const glm::dvec2& to, const glm::dvec2& place) noexcept {
    const glm::dvec2 along = to - from;
    const double share = std::clamp(glm::dot(place - from, along) / std::max(glm::dot(along, along), 1e-12), 0.0, 1.0);
    return glm::distance(place, from + share * along);
}

Nearest nearestOn(const std::vector<glm::dvec2>& line, const glm::dvec2& place) noexcept {
    Nearest best{std::numeric_limits<double>::infinity(), 0.0};
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
        const glm::dvec2 along = line[k + 1] - line[k];
        const double share =
            std::clamp(glm::dot(place - line[k], along) / std::max(glm::dot(along, along), 1e-12), 0.0, 1.0);
        const double distance = glm::distance(place, line[k] + share * along);
        if (distance < best.distance)
            best = {distance, (static_cast<double>(k) + share) / static_cast<double>(line.size() - 1)};
    }
    return best;
}

std::vector<glm::dvec2> rectangle(const glm::dvec2& centre, const glm::dvec2& along, double length, double depth) {
    const glm::dvec2 a = 0.5 * length * along, b = 0.5 * depth * glm::dvec2(-along.y, along.x);
    return {centre - a - b, centre + a - b, centre + a + b, centre - a + b};
}

std::vector<glm::dvec2> roundOutline(const glm::dvec2& centre, double radius, int corners) {
    std::vector<glm::dvec2> outline;
    for (int k = 0; k < corners; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / corners;
        outline.push_back(centre + radius * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
    return outline;
}

bool overlap(const std::vector<glm::dvec2>& a, const std::vector<glm::dvec2>& b) noexcept {
    return !apart(a, b) && !apart(b, a);
}

double doubleArea(const std::vector<glm::dvec2>& outline) noexcept {
    double sum = 0.0;
    for (std::size_t k = 0; k < outline.size(); ++k) {
        const glm::dvec2 &a = outline[k], &b = outline[(k + 1) % outline.size()];
        sum += a.x * b.y - b.x * a.y;
    }
    return sum;
}

bool isConvex(const std::vector<glm::dvec2>& outline) noexcept {
    const std::size_t count = outline.size();
    for (std::size_t k = 0; k < count; ++k) {
        const glm::dvec2 a = outline[(k + 1) % count] - outline[k];
        const glm::dvec2 b = outline[(k + 2) % count] - outline[(k + 1) % count];
        if (a.x * b.y - a.y * b.x < -1e-9) return false;
    }
    return true;
}

std::vector<glm::dvec2> bridged(std::vector<glm::dvec2> outline, std::vector<std::vector<glm::dvec2>> holes) {
    std::erase_if(holes, [](const auto& hole) { return hole.size() < 3; });
    const auto eastmost = [](const std::vector<glm::dvec2>& hole) {
        return std::ranges::max_element(hole, {}, &glm::dvec2::x);
    };
    // From the east, so that a hole's bridge never has to pass one that is not joined yet.
    std::ranges::sort(holes, std::ranges::greater(), [&](const auto& hole) { return eastmost(hole)->x; });
    const bool clockwise = doubleArea(outline) > 0.0;
    for (std::size_t h = 0; h < holes.size(); ++h) {
        std::vector<glm::dvec2>& hole = holes[h];
        if ((doubleArea(hole) > 0.0) == clockwise) std::ranges::reverse(hole); // round the other way
        std::rotate(hole.begin(), hole.begin() + (eastmost(hole) - hole.cbegin()), hole.end());
        const glm::dvec2 from = hole.front();
        std::vector<std::size_t> order(outline.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::sort(order, {}, [&](std::size_t k) { return glm::distance(outline[k], from); });
        const auto isFree = [&](std::size_t k) {
            if (crosses(outline, from, outline[k])) return false;
            return std::all_of(holes.begin() + static_cast<std::ptrdiff_t>(h), holes.end(),
                               [&](const auto& other) { return !crosses(other, from, outline[k]); });
        };
        const auto isPassedOnce = [&](std::size_t k) { return std::ranges::count(outline, outline[k]) == 1; };
        auto found = std::ranges::find_if(order, [&](std::size_t k) { return isPassedOnce(k) && isFree(k); });
        if (found == order.end()) found = std::ranges::find_if(order, isFree);
        const auto at = static_cast<std::ptrdiff_t>(found == order.end() ? order.front() : *found);
        std::vector<glm::dvec2> way(hole);
        way.push_back(from);
        way.push_back(outline[static_cast<std::size_t>(at)]);
        outline.insert(outline.begin() + at + 1, way.begin(), way.end());
    }
    return outline;
}

std::vector<std::vector<glm::dvec2>> convexParts(const std::vector<glm::dvec2>& outline,
                                                 const std::vector<std::vector<glm::dvec2>>& holes) {
    if (holes.empty() && isConvex(outline)) return {outline};
    const std::vector<glm::dvec2> ring = bridged(outline, holes);
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> corners;
    for (const glm::dvec2& p : ring) {
        corners.push_back(static_cast<std::uint32_t>(positions.size()));
        positions.emplace_back(glm::vec2(p - ring.front()), 0.0F);
    }
    std::vector<glm::uvec3> triangles;
    triangulatePolygon(positions, corners, triangles);
    std::vector<std::vector<glm::dvec2>> parts;
    for (const glm::uvec3& t : triangles) {
        std::vector<glm::dvec2> part{ring[t.x], ring[t.y], ring[t.z]};
        if (doubleArea(part) < 0.0) std::swap(part[1], part[2]);
        if (doubleArea(part) > 0.1) parts.push_back(std::move(part));
    }
    return parts;
}

double smoothStep(double from, double to, double value) noexcept {
    const double t = std::clamp((value - from) / (to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

} // namespace lumorph::navigation
