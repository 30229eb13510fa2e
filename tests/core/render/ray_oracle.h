#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace lumorph {

/// Casts rays at a soup of triangles: a plain judge of what is seen and what is in shadow. Double precision, no GL.
class RayOracle {
public:
    struct Hit {
        double distance = 0.0;
        glm::dvec3 normal{0.0}; ///< of the triangle, towards where the ray came from
        glm::dvec3 outside{0.0}; ///< of the triangle, as it winds
        int thing = 0;
    };

    void add(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, int thing) {
        triangles_.push_back({a, b, c, thing});
    }
    void build() {
        order_.resize(triangles_.size());
        std::iota(order_.begin(), order_.end(), 0U);
        nodes_.clear();
        split(0, static_cast<std::uint32_t>(order_.size()));
    }
    /// The nearest triangle along a ray, from `nearest` on; `thing` -1: any.
    [[nodiscard]] std::optional<Hit> cast(const glm::dvec3& from, const glm::dvec3& direction, double nearest = 1e-9,
                                          int thing = -1) const {
        std::optional<Hit> best;
        if (!nodes_.empty()) visit(0, from, direction, nearest, thing, best);
        return best;
    }

private:
    struct Triangle {
        glm::dvec3 a, b, c;
        int thing;
    };
    struct Node {
        glm::dvec3 low, high;
        std::uint32_t first = 0, last = 0, right = 0; ///< right 0: a leaf
    };

    std::uint32_t split(std::uint32_t first, std::uint32_t last) {
        const auto index = static_cast<std::uint32_t>(nodes_.size());
        Node node{glm::dvec3(1e30), glm::dvec3(-1e30), first, last, 0};
        for (std::uint32_t i = first; i < last; ++i) {
            const Triangle& t = triangles_[order_[i]];
            node.low = glm::min(node.low, glm::min(t.a, glm::min(t.b, t.c)));
            node.high = glm::max(node.high, glm::max(t.a, glm::max(t.b, t.c)));
        }
        nodes_.push_back(node);
        if (last - first <= 4) return index;
        const glm::dvec3 size = node.high - node.low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::uint32_t middle = (first + last) / 2;
        const auto centre = [&](std::uint32_t i) {
            return triangles_[i].a[axis] + triangles_[i].b[axis] + triangles_[i].c[axis];
        };
        std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                         [&](std::uint32_t i, std::uint32_t j) { return centre(i) < centre(j); });
        split(first, middle);
        const std::uint32_t right = split(middle, last);
        nodes_[index].right = right;
        return index;
    }

    static bool meets(const Node& node, const glm::dvec3& from, const glm::dvec3& direction, double limit) {
        double enter = 0.0;
        double leave = limit;
        for (int k = 0; k < 3; ++k) {
            const double a = (node.low[k] - 1e-9 - from[k]) / direction[k];
            const double b = (node.high[k] + 1e-9 - from[k]) / direction[k];
            if (a != a || b != b) continue; // along the slab's side
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        return enter <= leave;
    }

    void visit(std::uint32_t index, const glm::dvec3& from, const glm::dvec3& direction, double nearest, int thing,
               std::optional<Hit>& best) const {
        const Node& node = nodes_[index];
        if (!meets(node, from, direction, best ? best->distance : std::numeric_limits<double>::infinity())) return;
        if (node.right != 0) {
            visit(index + 1, from, direction, nearest, thing, best);
            visit(node.right, from, direction, nearest, thing, best);
            return;
        }
        for (std::uint32_t i = node.first; i < node.last; ++i) {
            const Triangle& t = triangles_[order_[i]];
            if (thing >= 0 && t.thing != thing) continue;
            const glm::dvec3 u = t.b - t.a;
            const glm::dvec3 v = t.c - t.a;
            const glm::dvec3 p = glm::cross(direction, v);
            const double det = glm::dot(u, p);
            if (det == 0.0) continue;
            const glm::dvec3 s = from - t.a;
            const double x = glm::dot(s, p) / det;
            const glm::dvec3 q = glm::cross(s, u);
            const double y = glm::dot(direction, q) / det;
            const double distance = glm::dot(v, q) / det;
            if (x < 0.0 || y < 0.0 || x + y > 1.0 || distance < nearest || (best && distance >= best->distance))
                continue;
            const glm::dvec3 outside = glm::normalize(glm::cross(u, v));
            best = Hit{distance, glm::dot(outside, direction) > 0.0 ? -outside : outside, outside, t.thing};
        }
    }

    std::vector<Triangle> triangles_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

} // namespace lumorph
