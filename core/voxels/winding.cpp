#include "core/voxels/winding.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <numeric>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

namespace lumorph {

namespace {

/// Signed solid angle of a triangle seen from `p` (Van Oosterom and Strackee 1983).
double solidAngle(const glm::dvec3& p, const glm::dvec3& v0, const glm::dvec3& v1, const glm::dvec3& v2) noexcept {
    const glm::dvec3 a = v0 - p;
    const glm::dvec3 b = v1 - p;
    const glm::dvec3 c = v2 - p;
    const double la = glm::length(a);
    const double lb = glm::length(b);
    const double lc = glm::length(c);
    const double numerator = glm::dot(a, glm::cross(b, c));
    const double denominator = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
    return 2.0 * std::atan2(numerator, denominator);
}

/// A tree of triangle clusters; each knows the dipole that stands for it from afar.
class WindingTree {
public:
    explicit WindingTree(const TriangleMesh& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
        std::iota(order_.begin(), order_.end(), 0U);
        centres_.reserve(order_.size());
        for (const glm::uvec3& t : mesh.triangles)
            centres_.push_back((position(t.x) + position(t.y) + position(t.z)) / 3.0);
        if (!order_.empty()) build(0, order_.size());
    }

    [[nodiscard]] double at(const glm::dvec3& point) const noexcept {
        return nodes_.empty() ? 0.0 : sum(0, point) / (4.0 * std::numbers::pi);
    }

private:
    struct Node {
        std::size_t begin, end;
        std::size_t left = 0, right = 0; // 0: a leaf
        glm::dvec3 centre{0.0};
        glm::dvec3 areaNormal{0.0};
        double radius = 0.0;
    };
    static constexpr std::size_t kLeafSize = 8;
    /// Clusters farther than this many radii are far; 3 keeps the sum within about 0.01.
    static constexpr double kFar = 3.0;

    [[nodiscard]] glm::dvec3 position(std::uint32_t vertex) const { return glm::dvec3(mesh_.positions[vertex]); }

    std::size_t build(std::size_t begin, std::size_t end) {
        const std::size_t index = nodes_.size();
        nodes_.push_back({begin, end});
        summarise(nodes_[index]);
        if (end - begin > kLeafSize) {
            glm::dvec3 low(INFINITY);
            glm::dvec3 high(-INFINITY);
            for (std::size_t i = begin; i < end; ++i) {
                low = glm::min(low, centres_[order_[i]]);
                high = glm::max(high, centres_[order_[i]]);
            }
            const glm::dvec3 size = high - low;
            const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
            const std::size_t middle = begin + (end - begin) / 2;
            std::nth_element(order_.begin() + static_cast<std::ptrdiff_t>(begin),
                             order_.begin() + static_cast<std::ptrdiff_t>(middle),
                             order_.begin() + static_cast<std::ptrdiff_t>(end),
                             [&](auto a, auto b) { return centres_[a][axis] < centres_[b][axis]; });
            const std::size_t left = build(begin, middle);
            const std::size_t right = build(middle, end);
            nodes_[index].left = left;
            nodes_[index].right = right;
        }
        return index;
    }

    void summarise(Node& node) const {
        double area = 0.0;
        for (std::size_t i = node.begin; i < node.end; ++i) {
            const glm::uvec3& t = mesh_.triangles[order_[i]];
            const glm::dvec3 n = 0.5 * glm::cross(position(t.y) - position(t.x), position(t.z) - position(t.x));
            const double a = glm::length(n);
            node.areaNormal += n;
            node.centre += a * centres_[order_[i]];
            area += a;
        }
        node.centre = area > 0.0 ? node.centre / area : centres_[order_[node.begin]];
        for (std::size_t i = node.begin; i < node.end; ++i) {
            const glm::uvec3& t = mesh_.triangles[order_[i]];
            for (const std::uint32_t vertex : {t.x, t.y, t.z})
                node.radius = std::max(node.radius, glm::distance(node.centre, position(vertex)));
        }
    }

    [[nodiscard]] double sum(std::size_t index, const glm::dvec3& point) const noexcept {
        const Node& node = nodes_[index];
        const glm::dvec3 toCentre = node.centre - point;
        const double distance = glm::length(toCentre);
        if (distance > kFar * node.radius)
            return glm::dot(node.areaNormal, toCentre) / (distance * distance * distance);
        if (node.left != 0) return sum(node.left, point) + sum(node.right, point);
        double result = 0.0;
        for (std::size_t i = node.begin; i < node.end; ++i) {
            const glm::uvec3& t = mesh_.triangles[order_[i]];
            result += solidAngle(point, position(t.x), position(t.y), position(t.z));
        }
        return result;
    }

    const TriangleMesh& mesh_;
    std::vector<std::uint32_t> order_;
    std::vector<glm::dvec3> centres_;
    std::vector<Node> nodes_;
};

} // namespace

double windingNumber(const TriangleMesh& mesh, const glm::dvec3& point) noexcept {
    double sum = 0.0;
    for (const glm::uvec3& t : mesh.triangles)
        sum += solidAngle(point, glm::dvec3(mesh.positions[t.x]), glm::dvec3(mesh.positions[t.y]),
                          glm::dvec3(mesh.positions[t.z]));
    return sum / (4.0 * std::numbers::pi);
}

BitColumns voxelizeWinding(const VoxelFrame& frame, const TriangleMesh& mesh, const Progress& progress) {
    const WindingTree tree(mesh);
    BitColumns out(frame.dimensions);
    std::atomic<int> done{0};
    tbb::parallel_for(0, frame.dimensions.z, [&](int z) {
        if (progress.cancelled()) return;
        for (int x = 0; x < frame.dimensions.x; ++x)
            for (int y = 0; y < frame.dimensions.y; ++y)
                if (std::abs(tree.at(frame.centre(x, y, z))) >= 0.5) out.set(x, y, z);
        progress.report(static_cast<double>(++done) / frame.dimensions.z, "voxelising an open mesh");
    });
    progress.throwIfCancelled();
    return out;
}

} // namespace lumorph
