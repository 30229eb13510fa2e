#include "core/voxels/surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace lumorph {

namespace {

/// The separating-axis test of one triangle against unit cubes of the grid. The axes that do not
/// involve y decide for a whole column; the others bound the range of y within it.
class TriangleBoxTest {
public:
    explicit TriangleBoxTest(const std::array<glm::dvec3, 3>& t) : t_(t) {
        const std::array<glm::dvec3, 3> edges{t[1] - t[0], t[2] - t[1], t[0] - t[2]};
        const std::array<glm::dvec3, 3> cubeAxes{glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)};
        addAxis(glm::cross(edges[0], edges[1]));
        for (const glm::dvec3& edge : edges)
            for (const glm::dvec3& axis : cubeAxes) addAxis(glm::cross(edge, axis));
        low_ = glm::min(t[0], glm::min(t[1], t[2]));
        high_ = glm::max(t[0], glm::max(t[1], t[2]));
    }

    [[nodiscard]] const glm::dvec3& low() const noexcept { return low_; }
    [[nodiscard]] const glm::dvec3& high() const noexcept { return high_; }

    /// Range of cube indices y whose cube in column (x, z) meets the triangle; empty when first > last.
    /// On every axis the cube must overlap the triangle's interval, which is a bound linear in y.
    [[nodiscard]] std::pair<int, int> columnRange(int x, int z, int y0, int y1) const noexcept {
        double first = y0;
        double last = y1;
        for (int i = 0; i < axisCount_; ++i) {
            const Axis& a = axes_[static_cast<std::size_t>(i)];
            const double base = a.direction.x * (x + 0.5) + a.direction.z * (z + 0.5);
            const double low = a.low - a.radius - base;
            const double high = a.high + a.radius - base;
            if (a.direction.y == 0.0) {
                if (low > 0.0 || high < 0.0) return {1, 0};
                continue;
            }
            const double p = low / a.direction.y - 0.5;
            const double q = high / a.direction.y - 0.5;
            first = std::max(first, std::ceil(std::min(p, q)));
            last = std::min(last, std::floor(std::max(p, q)));
            if (first > last) return {1, 0};
        }
        return {static_cast<int>(first), static_cast<int>(last)};
    }

private:
    struct Axis {
        glm::dvec3 direction;
        double low, high, radius;
    };
    void addAxis(const glm::dvec3& direction) {
        if (direction == glm::dvec3(0.0)) return;
        const double a = glm::dot(direction, t_[0]);
        const double b = glm::dot(direction, t_[1]);
        const double c = glm::dot(direction, t_[2]);
        // The rounding of the dot products must not part what touches.
        const double slack = 1e-12 * (std::abs(a) + std::abs(b) + std::abs(c));
        const double radius = 0.5 * (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z));
        axes_[static_cast<std::size_t>(axisCount_++)] = {direction, std::min({a, b, c}), std::max({a, b, c}),
                                                         radius + slack};
    }

    std::array<glm::dvec3, 3> t_;
    std::array<Axis, 10> axes_{};
    int axisCount_ = 0;
    glm::dvec3 low_{};
    glm::dvec3 high_{};
};

} // namespace

BitColumns voxelizeSurface(const VoxelFrame& frame, const TriangleMesh& mesh) {
    BitColumns out(frame.dimensions);
    const glm::dvec3 last(frame.dimensions - 1);
    for (const glm::uvec3& t : mesh.triangles) {
        const auto inGrid = [&](std::uint32_t vertex) {
            return (glm::dvec3(mesh.positions[vertex]) - glm::dvec3(frame.origin)) / frame.voxelSize;
        };
        const TriangleBoxTest test({inGrid(t.x), inGrid(t.y), inGrid(t.z)});
        // A triangle in the plane between two cubes touches both.
        const glm::dvec3 first = glm::max(glm::ceil(test.low()) - 1.0, 0.0);
        const glm::dvec3 end = glm::min(glm::floor(test.high()), last);
        if (first.x > end.x || first.y > end.y || first.z > end.z) continue;
        for (int z = static_cast<int>(first.z); z <= static_cast<int>(end.z); ++z)
            for (int x = static_cast<int>(first.x); x <= static_cast<int>(end.x); ++x) {
                const auto [y0, y1] = test.columnRange(x, z, static_cast<int>(first.y), static_cast<int>(end.y));
                for (int y = y0; y <= y1; ++y) out.set(x, y, z);
            }
    }
    return out;
}

} // namespace lumorph
