#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "core/voxels/voxel_frame.h"

namespace lumorph {

/// A vertex in grid coordinates: x and z in fixed point with the column centres at multiples of
/// `1 << shift`, y in voxels with the voxel centres at whole numbers.
///
/// Fixed point makes the edge tests below exact: whatever the mesh, a column goes through exactly one
/// of the triangles that share an edge, so a closed mesh never leaks.
struct GridVertex {
    std::int32_t x = 0;
    std::int32_t z = 0;
    float y = 0.0F;
    std::int32_t padding = 0;
};

/// Converts positions to grid coordinates of a frame.
class GridSnap {
public:
    /// `reach` must hold every position that will be converted: far points get fewer fraction bits.
    GridSnap(const VoxelFrame& frame, const Box& reach) noexcept
        : origin_(frame.origin), voxelsPerMetre_(static_cast<float>(1.0 / frame.voxelSize)) {
        const glm::vec3 low = glm::abs(reach.min - frame.origin) * voxelsPerMetre_;
        const glm::vec3 high = glm::abs(reach.max - frame.origin) * voxelsPerMetre_;
        const float farthest = std::max({low.x, low.z, high.x, high.z, 1.0F});
        // 29 bits in all keep the products of two differences within 61 bits.
        shift_ = std::clamp(28 - static_cast<int>(std::ceil(std::log2(farthest))), 0, 16);
        fixedPerMetre_ = std::ldexp(voxelsPerMetre_, shift_);
        half_ = std::ldexp(0.5F, shift_);
    }

    [[nodiscard]] int shift() const noexcept { return shift_; }

    [[nodiscard]] GridVertex operator()(const glm::vec3& p) const noexcept {
        constexpr float kLimit = static_cast<float>(1 << 29);
        const float x = (p.x - origin_.x) * fixedPerMetre_ - half_;
        const float z = (p.z - origin_.z) * fixedPerMetre_ - half_;
        return {static_cast<std::int32_t>(std::min(std::max(x, -kLimit), kLimit)),
                static_cast<std::int32_t>(std::min(std::max(z, -kLimit), kLimit)),
                (p.y - origin_.y) * voxelsPerMetre_ - 0.5F};
    }

private:
    glm::vec3 origin_;
    float voxelsPerMetre_;
    float fixedPerMetre_ = 1.0F;
    float half_ = 0.5F;
    int shift_ = 16;
};

/// A range of columns, ends included; empty while `x0 > x1`.
struct ColumnRange {
    int x0 = 0;
    int x1 = -1;
    int z0 = 0;
    int z1 = -1;

    [[nodiscard]] bool empty() const noexcept { return x0 > x1 || z0 > z1; }
    [[nodiscard]] int width() const noexcept { return x1 - x0 + 1; }
    [[nodiscard]] int depth() const noexcept { return z1 - z0 + 1; }
    [[nodiscard]] std::size_t size() const noexcept {
        return empty() ? 0 : static_cast<std::size_t>(width()) * static_cast<std::size_t>(depth());
    }
    [[nodiscard]] ColumnRange intersect(const ColumnRange& o) const noexcept {
        return {std::max(x0, o.x0), std::min(x1, o.x1), std::max(z0, o.z0), std::min(z1, o.z1)};
    }
    void include(const ColumnRange& o) noexcept {
        if (o.empty()) return;
        if (empty()) {
            *this = o;
            return;
        }
        *this = {std::min(x0, o.x0), std::max(x1, o.x1), std::min(z0, o.z0), std::max(z1, o.z1)};
    }
    bool operator==(const ColumnRange&) const = default;
};

/// All columns of a frame.
[[nodiscard]] inline ColumnRange columnsOf(const VoxelFrame& frame) noexcept {
    return {0, frame.dimensions.x - 1, 0, frame.dimensions.z - 1};
}

/// std::ceil as an int for y in [-1, 1e8]; the x86-64 baseline has no instruction for it.
[[nodiscard]] inline int ceilToInt(float y) noexcept {
    const int towardsZero = static_cast<int>(y);
    return towardsZero + static_cast<int>(static_cast<float>(towardsZero) < y);
}

/// Calls `crossing(x, z, level, entering)` for every column centre of `range` that the triangle
/// covers seen along y: voxels with index >= level lie above the triangle there (level may be
/// outside the grid), and `entering` tells whether going up means going into the solid.
template <typename Crossing>
inline void rasterizeTriangle(const GridVertex& a, const GridVertex& b, const GridVertex& c, int shift,
                              const ColumnRange& range, Crossing&& crossing) noexcept {
    const std::int32_t mask = (std::int32_t{1} << shift) - 1;
    const int x0 = std::max((std::min({a.x, b.x, c.x}) + mask) >> shift, range.x0);
    const int x1 = std::min(std::max({a.x, b.x, c.x}) >> shift, range.x1);
    if (x0 > x1) return; // most triangles of a fine mesh end here: they lie between column centres
    const int z0 = std::max((std::min({a.z, b.z, c.z}) + mask) >> shift, range.z0);
    const int z1 = std::min(std::max({a.z, b.z, c.z}) >> shift, range.z1);
    if (z0 > z1) return;

    const std::int64_t area = std::int64_t{b.x - a.x} * (c.z - a.z) - std::int64_t{b.z - a.z} * (c.x - a.x);
    if (area == 0) return;
    // Seen from above the faces that look down turn this way round.
    const bool entering = area > 0;
    const GridVertex& p = a;
    const GridVertex& q = entering ? b : c;
    const GridVertex& r = entering ? c : b;

    // Edge functions are positive inside; an edge owns the points on it only in one of the two
    // directions in which neighbouring triangles run through it.
    struct Edge {
        std::int64_t dx, dz, value;
    };
    const auto edge = [&](const GridVertex& from, const GridVertex& to) noexcept {
        const std::int64_t dx = to.x - from.x;
        const std::int64_t dz = to.z - from.z;
        const std::int64_t px = (std::int64_t{x0} << shift) - from.x;
        const std::int64_t pz = (std::int64_t{z0} << shift) - from.z;
        const std::int64_t owns = (dz > 0 || (dz == 0 && dx < 0)) ? 0 : 1;
        return Edge{dx << shift, dz << shift, dx * pz - dz * px - owns};
    };
    Edge e0 = edge(q, r);
    Edge e1 = edge(r, p);
    Edge e2 = edge(p, q);
    const float inverse = 1.0F / static_cast<float>(area > 0 ? area : -area);
    for (int z = z0; z <= z1; ++z) {
        std::int64_t v0 = e0.value;
        std::int64_t v1 = e1.value;
        std::int64_t v2 = e2.value;
        for (int x = x0; x <= x1; ++x) {
            if ((v0 | v1 | v2) >= 0) {
                const float y =
                    p.y + (static_cast<float>(v1) * (q.y - p.y) + static_cast<float>(v2) * (r.y - p.y)) * inverse;
                crossing(x, z, ceilToInt(std::min(std::max(y, -1.0F), 1e8F)), entering);
            }
            v0 -= e0.dz;
            v1 -= e1.dz;
            v2 -= e2.dz;
        }
        e0.value += e0.dx;
        e1.value += e1.dx;
        e2.value += e2.dx;
    }
}

} // namespace lumorph
