#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include <glm/geometric.hpp>

#include "core/geometry/plane_mesh.h"
#include "core/rig/templates/sheet_device.h"
#include "core/rig/templates/sheet_outline.h"

namespace lumorph::test {

/// A sheet device as a hand may draw it: an outline of any kind, and up to six lines across it from edge to edge or
/// within it, a little too long or too short, wherever others lie.
class RandomDrawing {
public:
    explicit RandomDrawing(unsigned seed) : random_(seed) {}

    SheetDevice draw() {
        SheetDevice device;
        device.outline = outline();
        device.thickness = between(0.0005, 0.004);
        device.housing = between(0.005, 0.03);
        device.arc = between(0.01, 0.03);
        const int lines = static_cast<int>(between(1.0, 7.0));
        for (int k = 0; k < lines; ++k) device.bends.push_back(line(device.outline, k));
        return device;
    }

private:
    double between(double low, double high) {
        return low + (high - low) * static_cast<double>(random_()) / 4294967296.0;
    }
    bool chance(double share) { return between(0.0, 1.0) < share; }

    std::vector<glm::dvec2> outline() {
        const double width = between(0.08, 0.3);
        const double depth = between(0.08, 0.3);
        const double kind = between(0.0, 4.0);
        if (kind < 1.0) return rectangleOutline(width, depth, chance(0.5) ? between(0.0, 0.03) : 0.0);
        if (kind < 2.0) return ellipseOutline(width, depth);
        std::vector<glm::dvec2> points; // a polygon around its middle, with small dents or large ones
        const int corners = static_cast<int>(between(3.0, 12.0));
        const double dent = kind < 3.0 ? 0.1 : 0.5;
        for (int k = 0; k < corners; ++k) {
            const double angle = 2.0 * std::numbers::pi * (k + between(0.1, 0.9)) / corners;
            const double share = 1.0 - between(0.0, dent);
            points.push_back(0.5 * share * glm::dvec2(width * std::cos(angle), depth * std::sin(angle)));
        }
        return points;
    }

    /// Whether a place lies within the sheet, a centimetre from its edge at least.
    static bool within(const std::vector<glm::dvec2>& outline, const glm::dvec2& place) {
        if (!insidePolygon(outline, place)) return false;
        for (std::size_t k = 0; k < outline.size(); ++k) {
            const glm::dvec2 way = outline[(k + 1) % outline.size()] - outline[k];
            const double share = std::clamp(glm::dot(place - outline[k], way) / glm::dot(way, way), 0.0, 1.0);
            if (glm::distance(place, outline[k] + share * way) < 0.01) return false;
        }
        return true;
    }

    BendLine line(const std::vector<glm::dvec2>& outline, int number) {
        const auto onEdge = [&] {
            const auto k = static_cast<std::size_t>(between(0.0, static_cast<double>(outline.size())));
            return outline[k] + between(0.0, 1.0) * (outline[(k + 1) % outline.size()] - outline[k]);
        };
        const glm::dvec2 a = onEdge();
        glm::dvec2 b = onEdge();
        while (!within(outline, 0.5 * (a + b))) b = onEdge();
        BendLine bend;
        bend.name = "line " + std::to_string(number + 1);
        const bool across = chance(0.5);
        bend.from = a + (across ? between(-0.1, 0.1) : between(0.1, 0.4)) * (b - a);
        bend.to = b - (across ? between(-0.1, 0.1) : between(0.1, 0.4)) * (b - a);
        if (chance(0.5)) bend.ends = BendLine::Ends::free;
        if (chance(0.3)) bend.side = chance(0.5) ? BendLine::Side::left : BendLine::Side::right;
        bend.angle = Angle::degrees(chance(0.5) ? 90.0 : between(20.0, 90.0));
        return bend;
    }

    std::mt19937 random_;
};

} // namespace lumorph::test
