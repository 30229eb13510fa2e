#include "core/rig/templates/sheet_outline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/geometry/plane_mesh.h"

namespace lumorph {
namespace {

constexpr double kChord = 1e-4;   ///< metres between a round edge and its chords
constexpr double kNearest = 3e-4; ///< metres; nearer points are one
constexpr std::size_t kMaxOutlinePoints = 1000;

bool segmentsMeet(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d) {
    const auto side = [](const glm::dvec2& p, const glm::dvec2& q, const glm::dvec2& r) {
        return crossOf(q - p, r - p);
    };
    return side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0 &&
           std::max(a.x, b.x) >= std::min(c.x, d.x) && std::max(c.x, d.x) >= std::min(a.x, b.x) &&
           std::max(a.y, b.y) >= std::min(c.y, d.y) && std::max(c.y, d.y) >= std::min(a.y, b.y);
}

bool simple(const std::vector<glm::dvec2>& p) {
    const std::size_t n = p.size();
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 2; j < n; ++j)
            if ((j + 1) % n != i && segmentsMeet(p[i], p[i + 1], p[j], p[(j + 1) % n])) return false;
    return true;
}

/// Without points that are too near to the one before, or on a straight way.
std::vector<glm::dvec2> thinned(const std::vector<glm::dvec2>& outline) {
    std::vector<glm::dvec2> points;
    for (const glm::dvec2& p : outline)
        if (points.empty() || glm::distance(p, points.back()) >= kNearest) points.push_back(p);
    while (points.size() > 1 && glm::distance(points.front(), points.back()) < kNearest) points.pop_back();
    std::vector<glm::dvec2> kept;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const glm::dvec2& before = kept.empty() ? points.back() : kept.back();
        const glm::dvec2 in = points[k] - before;
        const glm::dvec2 out = points[(k + 1) % points.size()] - points[k];
        if (std::abs(crossOf(in, out)) > 1e-6 * glm::length(in) * glm::length(out) || glm::dot(in, out) < 0.0)
            kept.push_back(points[k]);
    }
    return kept;
}

} // namespace

std::vector<glm::dvec2> rectangleOutline(double width, double depth, double cornerRadius) {
    const glm::dvec2 half(0.5 * width, 0.5 * depth);
    const double radius = std::min({cornerRadius, half.x, half.y});
    const int steps =
        radius > kChord ? static_cast<int>(std::ceil(0.25 * std::numbers::pi / std::acos(1.0 - kChord / radius))) : 0;
    std::vector<glm::dvec2> outline;
    for (int corner = 0; corner < 4; ++corner) {
        const glm::dvec2 sign(corner == 0 || corner == 3 ? 1.0 : -1.0, corner < 2 ? 1.0 : -1.0);
        for (int k = 0; k <= steps; ++k) {
            const double angle =
                0.5 * std::numbers::pi * (corner + (steps == 0 ? 0.0 : static_cast<double>(k) / steps));
            const glm::dvec2 round = steps == 0 ? sign * radius : radius * glm::dvec2(std::cos(angle), std::sin(angle));
            outline.push_back(sign * (half - radius) + round);
        }
    }
    return outline;
}

std::vector<glm::dvec2> ellipseOutline(double width, double depth) {
    const double radius = 0.5 * std::max(width, depth);
    const int steps = radius > kChord
                          ? std::clamp(static_cast<int>(std::ceil(std::numbers::pi / std::acos(1.0 - kChord / radius))),
                                       16, static_cast<int>(kMaxOutlinePoints))
                          : 16;
    std::vector<glm::dvec2> outline;
    for (int k = 0; k < steps; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / steps;
        outline.emplace_back(0.5 * width * std::cos(angle), 0.5 * depth * std::sin(angle));
    }
    return outline;
}

OutlineBox boxOf(const std::vector<glm::dvec2>& outline) noexcept {
    if (outline.empty()) return {};
    OutlineBox box{outline.front(), outline.front()};
    for (const glm::dvec2& p : outline) {
        box.low = glm::min(box.low, p);
        box.high = glm::max(box.high, p);
    }
    return box;
}

std::vector<glm::dvec2> checkedOutline(const std::vector<glm::dvec2>& outline, const std::string& subject) {
    for (const glm::dvec2& p : outline)
        if (!std::isfinite(p.x) || !std::isfinite(p.y))
            throw InvalidInput(subject, "a point of the outline is no finite number", "draw the outline again");
    std::vector<glm::dvec2> points = thinned(outline);
    if (points.size() < 3)
        throw InvalidInput(subject, "the outline encloses nothing", "give it at least three corners");
    if (points.size() > kMaxOutlinePoints)
        throw InvalidInput(subject, "the outline has " + std::to_string(points.size()) + " corners",
                           "simplify it to at most " + std::to_string(kMaxOutlinePoints));
    const glm::dvec2 size = boxOf(points).size();
    if (std::min(size.x, size.y) < 0.02 || std::max(size.x, size.y) > 2.0)
        throw InvalidInput(subject,
                           "the outline is " + std::to_string(100.0 * size.x) + " x " + std::to_string(100.0 * size.y) +
                               " cm large",
                           "make it 2 to 200 cm wide and deep");
    if (!simple(points))
        throw InvalidInput(subject, "the outline crosses itself", "draw it as one loop without a knot");
    if (signedArea(points) < 0.0) std::ranges::reverse(points);
    return points;
}

std::vector<glm::dvec2> convexHull(std::vector<glm::dvec2> points) {
    if (points.size() < 3) return points;
    const auto turnBetween = [](const glm::dvec2& in, const glm::dvec2& out) { return in.x * out.y - in.y * out.x; };
    std::ranges::sort(points, [](const auto& a, const auto& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
    std::vector<glm::dvec2> hull;
    for (const int pass : {0, 1}) {
        const std::size_t base = hull.size();
        for (const glm::dvec2& p : points) {
            while (hull.size() > base + 1 && turnBetween(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 1e-9)
                hull.pop_back();
            hull.push_back(p);
        }
        hull.pop_back();
        if (pass == 0) std::ranges::reverse(points);
    }
    return hull;
}

std::vector<glm::dvec2> grownHull(const std::vector<glm::dvec2>& points, double margin) {
    const std::vector<glm::dvec2> hull = convexHull(points);
    std::vector<glm::dvec2> grown;
    const std::size_t count = hull.size();
    for (std::size_t k = 0; k < count; ++k) {
        const glm::dvec2 in = glm::normalize(hull[k] - hull[(k + count - 1) % count]);
        const glm::dvec2 out = glm::normalize(hull[(k + 1) % count] - hull[k]);
        const glm::dvec2 before(in.y, -in.x);
        const glm::dvec2 after(out.y, -out.x);
        const glm::dvec2 middle = glm::normalize(before + after);
        const double half = std::acos(std::clamp(glm::dot(before, middle), -1.0, 1.0));
        if (half < 0.83) { // up to a right angle and a little more: a corner
            grown.push_back(hull[k] + middle * (margin / std::cos(half)));
        } else { // sharper ones are cut off, at the same distance
            const double side = margin * (1.0 - std::cos(half)) / std::sin(half);
            grown.push_back(hull[k] + margin * middle - side * glm::dvec2(-middle.y, middle.x));
            grown.push_back(hull[k] + margin * middle + side * glm::dvec2(-middle.y, middle.x));
        }
    }
    return grown;
}

} // namespace lumorph
