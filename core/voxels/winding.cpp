#include "core/voxels/winding.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

namespace lumorph {

namespace {

/// Half the signed solid angle of a triangle seen from a point, as the angle of a complex number.
struct HalfAngle {
    double real = 1.0, imaginary = 0.0;
};

/// After Van Oosterom and Strackee 1983.
HalfAngle halfSolidAngle(const glm::dvec3& p, const glm::dvec3& v0, const glm::dvec3& v1,
                         const glm::dvec3& v2) noexcept {
    const glm::dvec3 a = v0 - p;
    const glm::dvec3 b = v1 - p;
    const glm::dvec3 c = v2 - p;
    const double la = glm::length(a);
    const double lb = glm::length(b);
    const double lc = glm::length(c);
    const double numerator = glm::dot(a, glm::cross(b, c));
    const double denominator = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
    return {denominator, numerator};
}

/// Adds angles up by multiplying: an arc tangent for each triangle would take most of the time.
class AngleSum {
public:
    void add(const HalfAngle& angle) noexcept {
        const double real = real_ * angle.real - imaginary_ * angle.imaginary;
        const double imaginary = real_ * angle.imaginary + imaginary_ * angle.real;
        if (angle.imaginary >= 0.0)
            turns_ += imaginary_ >= 0.0 && imaginary < 0.0 ? 1 : 0;
        else
            turns_ -= imaginary_ < 0.0 && imaginary > 0.0 ? 1 : 0;
        const double size = std::abs(real) + std::abs(imaginary);
        if (!(size > 0.0)) return; // the point is a corner of the triangle
        real_ = real / size;
        imaginary_ = imaginary / size;
    }
    /// As a solid angle.
    [[nodiscard]] double total() const noexcept {
        return 2.0 * std::atan2(imaginary_, real_) + 4.0 * std::numbers::pi * turns_;
    }

private:
    double real_ = 1.0, imaginary_ = 0.0;
    int turns_ = 0;
};

double squareFromEdge(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) noexcept {
    const glm::dvec3 edge = b - a;
    const double square = glm::dot(edge, edge);
    const double along = square > 0.0 ? std::clamp(glm::dot(p - a, edge) / square, 0.0, 1.0) : 0.0;
    const glm::dvec3 way = p - a - along * edge;
    return glm::dot(way, way);
}

/// The square of the distance of a point from a triangle.
double squareFromTriangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) noexcept {
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const auto inside = [&](const glm::dvec3& from, const glm::dvec3& to) {
        return glm::dot(glm::cross(to - from, p - from), normal) > 0.0;
    };
    if (inside(a, b) && inside(b, c) && inside(c, a)) {
        const double height = glm::dot(p - a, normal);
        return height * height / glm::dot(normal, normal);
    }
    return std::min({squareFromEdge(p, a, b), squareFromEdge(p, b, c), squareFromEdge(p, c, a)});
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

    struct Node {
        std::size_t begin, end;
        std::size_t left = 0, right = 0; // 0: a leaf
        glm::dvec3 centre{0.0};
        glm::dvec3 areaNormal{0.0};
        double radius = 0.0;
    };
    /// Clusters farther than this many radii are far; 3 keeps the sum within about 0.01.
    static constexpr double kFar = 3.0;

    [[nodiscard]] const std::vector<Node>& nodes() const noexcept { return nodes_; }
    [[nodiscard]] std::span<const std::uint32_t> trianglesOf(const Node& node) const noexcept {
        return std::span(order_).subspan(node.begin, node.end - node.begin);
    }
    [[nodiscard]] std::array<glm::dvec3, 3> corners(std::uint32_t triangle) const noexcept {
        const glm::uvec3& t = mesh_.triangles[triangle];
        return {position(t.x), position(t.y), position(t.z)};
    }
    /// The solid angle of a far cluster.
    [[nodiscard]] static double dipole(const Node& node, const glm::dvec3& point) noexcept {
        const glm::dvec3 toCentre = node.centre - point;
        const double distance = glm::length(toCentre);
        return glm::dot(node.areaNormal, toCentre) / (distance * distance * distance);
    }

    /// Adds what a cluster contributes: `far` gets the dipoles, `exact` the rest.
    void add(std::size_t index, const glm::dvec3& point, AngleSum& exact, double& far) const noexcept {
        const Node& node = nodes_[index];
        if (glm::distance(node.centre, point) > kFar * node.radius) {
            far += dipole(node, point);
        } else if (node.left != 0) {
            add(node.left, point, exact, far);
            add(node.right, point, exact, far);
        } else {
            for (const std::uint32_t triangle : trianglesOf(node)) {
                const auto [a, b, c] = corners(triangle);
                exact.add(halfSolidAngle(point, a, b, c));
            }
        }
    }

private:
    static constexpr std::size_t kLeafSize = 8;

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

    const TriangleMesh& mesh_;
    std::vector<std::uint32_t> order_;
    std::vector<glm::dvec3> centres_;
    std::vector<Node> nodes_;
};

/// Finds winding numbers block by block. What is far from a block varies smoothly in it: it is summed at 27 points and
/// interpolated, in halves of halves of the block with ever less that is near. So what a triangle costs does not grow
/// with all voxels, but with those close to it.
class WindingBlocks {
public:
    static constexpr int kLargest = 16; ///< voxels along a side

    WindingBlocks(const VoxelFrame& frame, const WindingTree& tree, BitColumns& out)
        : frame_(frame), tree_(tree), out_(out) {}

    /// Blocks may run side by side along x and z, not along y: columns are words of voxels.
    void solve(const glm::ivec3& low, const Progress& progress) {
        const glm::ivec3 size = glm::min(glm::ivec3(kLargest), frame_.dimensions - low);
        if (!tree_.nodes().empty()) solve({low, size}, Sums{}, {{0}, {}}, progress);
    }

private:
    static constexpr int kSmallest = 4;
    /// What is farther than so many radii of a block is smooth enough in it: a parabola misses the angle of a
    /// triangle by at most 0.002 turns, that of a dipole by two hundredths of it.
    static constexpr double kSmoothTriangle = 1.25;
    static constexpr double kSmoothDipole = 2.0;
    static constexpr double kNode = 0.8660254037844386; ///< where a parabola fits best (Chebyshev), of half a side
    static constexpr int kPoints = 27;
    using Sums = std::array<double, kPoints>; ///< solid angles at the points of a block

    struct Block {
        glm::ivec3 low, size;
    };
    struct Near {
        std::vector<std::size_t> clusters;
        std::vector<std::uint32_t> triangles;
    };

    /// Half of the box that holds the centres of a block's voxels.
    [[nodiscard]] glm::dvec3 halfOf(const Block& block) const {
        return 0.5 * frame_.voxelSize * glm::max(glm::dvec3(block.size - 1), 1.0);
    }
    [[nodiscard]] glm::dvec3 middleOf(const Block& block) const {
        const glm::ivec3 last = block.low + block.size - 1;
        return 0.5 * (frame_.centre(block.low.x, block.low.y, block.low.z) + frame_.centre(last.x, last.y, last.z));
    }
    static glm::dvec3 point(const glm::dvec3& middle, const glm::dvec3& half, int number) {
        return middle + kNode * half * (glm::dvec3(number % 3, number / 3 % 3, number / 9) - 1.0);
    }

    /// The three weights of the points along one axis at a place, -1 to 1 in the block.
    static glm::dvec3 weightsAt(double place) {
        const double at = place / kNode;
        return {0.5 * at * (at - 1.0), 1.0 - at * at, 0.5 * at * (at + 1.0)};
    }
    static double interpolated(const Sums& sums, const glm::dvec3& place) {
        const glm::dvec3 x = weightsAt(place.x);
        const glm::dvec3 y = weightsAt(place.y);
        const glm::dvec3 z = weightsAt(place.z);
        double value = 0.0;
        for (int i = 0; i < kPoints; ++i)
            value += sums[static_cast<std::size_t>(i)] * x[i % 3] * y[i / 3 % 3] * z[i / 9];
        return value;
    }

    void solve(const Block& block, Sums sums, Near near, const Progress& progress) {
        if (progress.cancelled()) return;
        const glm::dvec3 middle = middleOf(block);
        const glm::dvec3 half = halfOf(block);
        const double radius = glm::length(half);
        std::array<glm::dvec3, kPoints> points;
        for (int i = 0; i < kPoints; ++i) points[static_cast<std::size_t>(i)] = point(middle, half, i);
        Near rest;
        while (!near.clusters.empty()) {
            const WindingTree::Node& node = tree_.nodes()[near.clusters.back()];
            const std::size_t index = near.clusters.back();
            near.clusters.pop_back();
            const double distance = glm::distance(node.centre, middle);
            const bool smooth = distance > kSmoothDipole * radius;
            if (smooth && distance - radius > WindingTree::kFar * node.radius) {
                for (std::size_t i = 0; i < kPoints; ++i) sums[i] += WindingTree::dipole(node, points[i]);
            } else if (!smooth && node.radius < 0.5 * radius) {
                rest.clusters.push_back(index);
            } else if (node.left != 0) {
                near.clusters.push_back(node.left);
                near.clusters.push_back(node.right);
            } else {
                const auto own = tree_.trianglesOf(node);
                near.triangles.insert(near.triangles.end(), own.begin(), own.end());
            }
        }
        std::array<AngleSum, kPoints> exact;
        for (const std::uint32_t triangle : near.triangles) {
            const auto [a, b, c] = tree_.corners(triangle);
            if (squareFromTriangle(middle, a, b, c) <= kSmoothTriangle * kSmoothTriangle * radius * radius) {
                rest.triangles.push_back(triangle);
                continue;
            }
            for (int i = 0; i < kPoints; ++i)
                exact[static_cast<std::size_t>(i)].add(halfSolidAngle(points[static_cast<std::size_t>(i)], a, b, c));
        }
        for (std::size_t i = 0; i < kPoints; ++i) sums[i] += exact[i].total();
        const int longest = std::max({block.size.x, block.size.y, block.size.z});
        longest > kSmallest ? split(block, sums, rest, progress) : decide(block, sums, rest);
    }

    void split(const Block& block, const Sums& sums, const Near& near, const Progress& progress) {
        const glm::dvec3 middle = middleOf(block);
        const glm::dvec3 half = halfOf(block);
        for (int part = 0; part < 8; ++part) {
            Block child = block;
            bool empty = false;
            for (int axis = 0; axis < 3; ++axis) {
                const bool upper = ((part >> axis) & 1) != 0;
                // A short side stays whole.
                const int first = block.size[axis] > kSmallest ? block.size[axis] / 2 : block.size[axis];
                child.low[axis] = block.low[axis] + (upper ? first : 0);
                child.size[axis] = upper ? block.size[axis] - first : first;
                empty = empty || child.size[axis] == 0;
            }
            if (empty) continue;
            Sums inner;
            for (int i = 0; i < kPoints; ++i)
                inner[static_cast<std::size_t>(i)] =
                    interpolated(sums, (point(middleOf(child), halfOf(child), i) - middle) / half);
            solve(child, inner, near, progress);
        }
    }

    /// Sets the voxels of a smallest block.
    void decide(const Block& block, const Sums& sums, const Near& near) {
        std::vector<std::array<glm::dvec3, 3>> corners;
        for (const std::uint32_t triangle : near.triangles) corners.push_back(tree_.corners(triangle));
        const glm::dvec3 middle = middleOf(block);
        const glm::dvec3 half = halfOf(block);
        for (int z = 0; z < block.size.z; ++z)
            for (int x = 0; x < block.size.x; ++x)
                for (int y = 0; y < block.size.y; ++y) {
                    const glm::ivec3 at = block.low + glm::ivec3(x, y, z);
                    const glm::dvec3 centre = frame_.centre(at.x, at.y, at.z);
                    AngleSum exact;
                    double far = interpolated(sums, (centre - middle) / half);
                    for (const std::size_t index : near.clusters) tree_.add(index, centre, exact, far);
                    for (const auto& [a, b, c] : corners) exact.add(halfSolidAngle(centre, a, b, c));
                    if (std::abs(exact.total() + far) >= 2.0 * std::numbers::pi) out_.set(at.x, at.y, at.z);
                }
    }

    const VoxelFrame& frame_;
    const WindingTree& tree_;
    BitColumns& out_;
};

} // namespace

double windingNumber(const TriangleMesh& mesh, const glm::dvec3& point) noexcept {
    AngleSum sum;
    for (const glm::uvec3& t : mesh.triangles)
        sum.add(halfSolidAngle(point, glm::dvec3(mesh.positions[t.x]), glm::dvec3(mesh.positions[t.y]),
                               glm::dvec3(mesh.positions[t.z])));
    return sum.total() / (4.0 * std::numbers::pi);
}

BitColumns voxelizeWinding(const VoxelFrame& frame, const TriangleMesh& mesh, const Progress& progress) {
    const WindingTree tree(mesh);
    BitColumns out(frame.dimensions);
    WindingBlocks blocks(frame, tree, out);
    const glm::ivec3 count = (frame.dimensions + WindingBlocks::kLargest - 1) / WindingBlocks::kLargest;
    std::atomic<int> done{0};
    tbb::parallel_for(0, count.x * count.z, [&](int column) {
        for (int y = 0; y < count.y; ++y)
            blocks.solve(WindingBlocks::kLargest * glm::ivec3(column % count.x, y, column / count.x), progress);
        progress.report(static_cast<double>(++done) / (count.x * count.z), "voxelising an open mesh");
    });
    progress.throwIfCancelled();
    return out;
}

} // namespace lumorph
