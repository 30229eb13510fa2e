#include "app/applications/navigation/shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

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

double smoothStep(double from, double to, double value) noexcept {
    const double t = std::clamp((value - from) / (to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

} // namespace lumorph::navigation
