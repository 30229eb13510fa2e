#include "core/rig/templates/plane_drawing.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace lumorph {

std::uint32_t PlaneDrawing::add(const glm::dvec2& p) {
    const glm::ivec2 cell(glm::floor(p / (2.0 * kSnap)));
    for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy) {
            const auto found = cells_.find({cell.x + dx, cell.y + dy});
            if (found == cells_.end()) continue;
            for (const std::uint32_t k : found->second)
                if (glm::distance(points_[k], p) < kSnap) return k;
        }
    const auto index = static_cast<std::uint32_t>(points_.size());
    points_.push_back(p);
    cells_[{cell.x, cell.y}].push_back(index);
    return index;
}

void PlaneDrawing::addLine(const glm::dvec2& from, const glm::dvec2& to, double spacing) {
    const int steps = std::max(1, static_cast<int>(std::ceil(glm::distance(from, to) / spacing - 1e-9)));
    glm::dvec2 last = from;
    for (int k = 1; k <= steps; ++k) {
        const glm::dvec2 next = k == steps ? to : from + (to - from) * (static_cast<double>(k) / steps);
        addEdge(last, next);
        last = next;
    }
}

PlaneMesh PlaneDrawing::triangulate() const {
    std::vector<PlaneEdge> edges;
    for (const auto& [a, b] : edges_) splitAtPoints(a, b, edges);
    std::ranges::sort(edges);
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return triangulateCrossing(points_, edges);
}

void PlaneDrawing::splitAtPoints(std::uint32_t a, std::uint32_t b, std::vector<PlaneEdge>& edges) const {
    if (a == b) return;
    const glm::dvec2 way = points_[b] - points_[a];
    const double length = glm::length(way);
    std::vector<std::pair<double, std::uint32_t>> on;
    for (std::uint32_t k = 0; k < points_.size(); ++k) {
        const glm::dvec2 to = points_[k] - points_[a];
        const double along = glm::dot(to, way) / length;
        if (k != a && k != b && along > 0.0 && along < length && std::abs(way.x * to.y - way.y * to.x) < kSnap * length)
            on.emplace_back(along, k);
    }
    std::ranges::sort(on);
    std::uint32_t last = a;
    on.emplace_back(length, b);
    for (const auto& [along, k] : on) {
        edges.push_back(std::minmax(last, k));
        last = k;
    }
}

} // namespace lumorph
