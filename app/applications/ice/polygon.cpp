#include "app/applications/ice/polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace lumorph::ice {
namespace {

constexpr double kSame = 1e-6;  ///< metres: closer lines are one
constexpr double kPoint = 1e-9; ///< metres: closer corners are one

/// Of an edge in its polygon.
const glm::dvec2& next(const Polygon& polygon, std::size_t k) noexcept { return polygon[(k + 1) % polygon.size()]; }

glm::dvec2 nearestOn(const glm::dvec2& from, const glm::dvec2& to, const glm::dvec2& place) noexcept {
    const glm::dvec2 along = to - from;
    const double square = glm::dot(along, along);
    return square > 0.0 ? from + along * std::clamp(glm::dot(place - from, along) / square, 0.0, 1.0) : from;
}

/// The common piece of two edges that run against each other on one line.
std::optional<Segment> overlap(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c,
                               const glm::dvec2& d) noexcept {
    const double length = glm::distance(a, b);
    if (length < kSame) return std::nullopt;
    const glm::dvec2 along = (b - a) / length;
    if (std::abs(cross(along, c - a)) > kSame || std::abs(cross(along, d - a)) > kSame) return std::nullopt;
    const double from = std::max(0.0, glm::dot(d - a, along)), to = std::min(length, glm::dot(c - a, along));
    if (to - from < kSame) return std::nullopt;
    return Segment{a + along * from, a + along * to};
}

bool boxesTouch(const Polygon& a, const Polygon& b) noexcept {
    constexpr double kFar = 1e9;
    glm::dvec2 minA(kFar), maxA(-kFar), minB(kFar), maxB(-kFar);
    for (const glm::dvec2& corner : a) minA = glm::min(minA, corner), maxA = glm::max(maxA, corner);
    for (const glm::dvec2& corner : b) minB = glm::min(minB, corner), maxB = glm::max(maxB, corner);
    return minA.x <= maxB.x + kSame && minB.x <= maxA.x + kSame && minA.y <= maxB.y + kSame && minB.y <= maxA.y + kSame;
}

} // namespace

glm::dvec2 placed(const Placement& placement, const glm::dvec2& home) noexcept {
    const double c = std::cos(placement.turn), s = std::sin(placement.turn);
    return placement.shift + glm::dvec2(c * home.x - s * home.y, s * home.x + c * home.y);
}

glm::dvec2 homeOf(const Placement& placement, const glm::dvec2& place) noexcept {
    const double c = std::cos(placement.turn), s = std::sin(placement.turn);
    const glm::dvec2 from = place - placement.shift;
    return {c * from.x + s * from.y, c * from.y - s * from.x};
}

double cross(const glm::dvec2& a, const glm::dvec2& b) noexcept { return a.x * b.y - a.y * b.x; }

double areaOf(const Polygon& polygon) noexcept {
    double twice = 0.0;
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
        twice += cross(polygon[k] - polygon[0], polygon[k + 1] - polygon[0]);
    return 0.5 * twice;
}

glm::dvec2 centreOf(const Polygon& polygon) noexcept {
    glm::dvec2 moment(0.0), sum(0.0);
    double twice = 0.0;
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
        const double part = cross(polygon[k] - polygon[0], polygon[k + 1] - polygon[0]);
        moment += part * (polygon[0] + polygon[k] + polygon[k + 1]) / 3.0;
        twice += part;
    }
    if (twice > 1e-15) return moment / twice;
    for (const glm::dvec2& corner : polygon) sum += corner;
    return polygon.empty() ? sum : sum / static_cast<double>(polygon.size());
}

bool holds(const Polygon& polygon, const glm::dvec2& place) noexcept {
    for (std::size_t k = 0; k < polygon.size(); ++k)
        if (cross(next(polygon, k) - polygon[k], place - polygon[k]) < 0.0) return false;
    return polygon.size() > 2;
}

glm::dvec2 nearestOnRim(const Polygon& polygon, const glm::dvec2& place) noexcept {
    glm::dvec2 nearest(0.0);
    double least = std::numeric_limits<double>::max();
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const glm::dvec2 on = nearestOn(polygon[k], next(polygon, k), place);
        const double distance = glm::distance(on, place);
        if (distance >= least) continue;
        least = distance;
        nearest = on;
    }
    return nearest;
}

Polygon clipped(const Polygon& polygon, const HalfPlane& half) {
    Polygon kept;
    kept.reserve(polygon.size() + 1);
    const auto add = [&](const glm::dvec2& corner) {
        if (kept.empty() || glm::distance(kept.back(), corner) > kPoint) kept.push_back(corner);
    };
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const glm::dvec2 &a = polygon[k], &b = next(polygon, k);
        const double beyondA = glm::dot(half.normal, a) - half.offset, beyondB = glm::dot(half.normal, b) - half.offset;
        if (beyondA <= 0.0) add(a);
        if ((beyondA < 0.0) != (beyondB < 0.0) && beyondA != beyondB)
            add(a + (b - a) * (beyondA / (beyondA - beyondB)));
    }
    while (kept.size() > 1 && glm::distance(kept.back(), kept.front()) <= kPoint) kept.pop_back();
    if (kept.size() < 3) kept.clear();
    return kept;
}

HalfPlane insideOf(const glm::dvec2& from, const glm::dvec2& to, double inset) noexcept {
    const glm::dvec2 along = to - from;
    const double length = glm::length(along);
    const glm::dvec2 outwards = length > 0.0 ? glm::dvec2(along.y, -along.x) / length : glm::dvec2(0.0);
    return {outwards, glm::dot(outwards, from) - inset};
}

std::optional<Segment> sharedEdge(const Polygon& a, const Polygon& b) noexcept {
    std::optional<Segment> longest;
    if (!boxesTouch(a, b)) return longest;
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = 0; j < b.size(); ++j) {
            if (glm::dot(next(a, i) - a[i], next(b, j) - b[j]) >= 0.0) continue;
            const auto common = overlap(a[i], next(a, i), b[j], next(b, j));
            if (common && (!longest || lengthOf(*common) > lengthOf(*longest))) longest = common;
        }
    }
    return longest;
}

double lengthOf(const Segment& segment) noexcept { return glm::distance(segment.from, segment.to); }

double distanceTo(const Segment& segment, const glm::dvec2& place) noexcept {
    return glm::distance(nearestOn(segment.from, segment.to, place), place);
}

} // namespace lumorph::ice
