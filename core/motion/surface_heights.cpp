#include "core/motion/surface_heights.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>

namespace lumorph {

namespace {

constexpr float kNothing = -std::numeric_limits<float>::infinity();
constexpr double kMostCells = 1024.0; // along an axis

bool isFinite(const glm::vec2& p) { return std::isfinite(p.x) && std::isfinite(p.y); }
bool isFinite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// Twice the area of a triangle, positive when it turns from x to z.
double area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

} // namespace

SurfaceHeights::SurfaceHeights(std::span<const glm::vec2> points)
    : points_(points.begin(), points.end()), highest_(points.size()) {
    glm::dvec2 low(std::numeric_limits<double>::max());
    glm::dvec2 high(std::numeric_limits<double>::lowest());
    std::size_t count = 0;
    for (const glm::vec2& p : points_)
        if (isFinite(p)) {
            low = glm::min(low, glm::dvec2(p));
            high = glm::max(high, glm::dvec2(p));
            ++count;
        }
    if (count == 0) return;
    // About one point a cell.
    origin_ = low;
    const glm::dvec2 size = high - low;
    const double longest = std::max(size.x, size.y);
    cell_ = std::max({std::sqrt(size.x * size.y / static_cast<double>(count)), longest / kMostCells, 1e-9});
    cells_ = glm::ivec2(size / cell_) + 1;
    const auto cellOf = [&](const glm::vec2& p) {
        const glm::ivec2 at = glm::clamp(glm::ivec2((glm::dvec2(p) - origin_) / cell_), glm::ivec2(0), cells_ - 1);
        return static_cast<std::size_t>(at.y) * static_cast<std::size_t>(cells_.x) + static_cast<std::size_t>(at.x);
    };
    starts_.assign(static_cast<std::size_t>(cells_.x) * static_cast<std::size_t>(cells_.y) + 1, 0);
    for (const glm::vec2& p : points_)
        if (isFinite(p)) ++starts_[cellOf(p) + 1];
    for (std::size_t k = 1; k < starts_.size(); ++k) starts_[k] += starts_[k - 1];
    order_.resize(count);
    std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
    for (std::uint32_t k = 0; k < points_.size(); ++k)
        if (isFinite(points_[k])) order_[next[cellOf(points_[k])]++] = k;
}

void SurfaceHeights::read(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                          std::span<float> out) {
    std::ranges::fill(highest_, kNothing);
    if (!order_.empty())
        for (const glm::uvec3& t : triangles) readTriangle(positions[t.x], positions[t.y], positions[t.z]);
    for (std::size_t k = 0; k < highest_.size(); ++k)
        if (highest_[k] != kNothing) out[k] = highest_[k];
}

void SurfaceHeights::readTriangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    if (!isFinite(a) || !isFinite(b) || !isFinite(c)) return;
    const glm::dvec2 pa(a.x, a.z);
    const glm::dvec2 pb(b.x, b.z);
    const glm::dvec2 pc(c.x, c.z);
    const double whole = area(pa, pb, pc);
    if (whole == 0.0) return; // it stands upright
    const glm::dvec2 low = (glm::min(pa, glm::min(pb, pc)) - origin_) / cell_;
    const glm::dvec2 high = (glm::max(pa, glm::max(pb, pc)) - origin_) / cell_;
    const glm::dvec2 most(cells_ - 1);
    if (high.x < 0.0 || high.y < 0.0 || low.x > most.x + 1.0 || low.y > most.y + 1.0) return;
    const glm::ivec2 first(glm::clamp(low, glm::dvec2(0.0), most));
    const glm::ivec2 last(glm::clamp(high, glm::dvec2(0.0), most));
    const double slack = -1e-9;
    for (int z = first.y; z <= last.y; ++z) {
        const auto row = static_cast<std::size_t>(z) * static_cast<std::size_t>(cells_.x);
        const std::uint32_t end = starts_[row + static_cast<std::size_t>(last.x) + 1];
        for (std::uint32_t k = starts_[row + static_cast<std::size_t>(first.x)]; k < end; ++k) {
            const glm::dvec2 p(points_[order_[k]]);
            const double u = area(p, pb, pc) / whole;
            const double v = area(pa, p, pc) / whole;
            const double w = 1.0 - u - v;
            if (u < slack || v < slack || w < slack) continue;
            float& highest = highest_[order_[k]];
            highest = std::max(highest, static_cast<float>(u * static_cast<double>(a.y) + v * static_cast<double>(b.y) +
                                                           w * static_cast<double>(c.y)));
        }
    }
}

void heightsOfMesh(const TriangleMesh& mesh, std::span<const glm::vec2> points, std::span<float> out) {
    SurfaceHeights(points).read(mesh.positions, mesh.triangles, out);
}

} // namespace lumorph
