#include "core/render/eye/creases.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <tuple>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/geometry/disjoint_sets.h"

namespace lumorph {
namespace {

constexpr int kMostSteps = 64;    // of one walk
constexpr float kFlat = 1e-4F;    // radians: what turns less is no part of a fold
constexpr float kOwnShare = 0.5F; // an edge that does this much of the turning is a fold by itself
constexpr float kAlong = 0.7F;    // cosine up to which two edges run along each other
constexpr float kSharp = 0.5F;    // radians of turning at one edge, at which a walk ends
constexpr double kShortest = 2.0; // radii that a fold runs at least, unless it is sharp
constexpr int kSofteningRounds = 8;

std::vector<std::uint32_t> placesOf(const std::vector<glm::vec3>& positions) {
    std::map<std::tuple<float, float, float>, std::uint32_t> first;
    std::vector<std::uint32_t> places(positions.size());
    for (std::uint32_t i = 0; i < positions.size(); ++i)
        places[i] = first.try_emplace({positions[i].x, positions[i].y, positions[i].z}, i).first->second;
    return places;
}

glm::vec3 unit(const glm::vec3& v) {
    const float length = glm::length(v);
    return length > 0.0F ? v / length : glm::vec3(0.0F);
}

} // namespace

CreaseFinder::CreaseFinder(const TriangleMesh& rest) : triangles_(rest.triangles) {
    for (const glm::uvec3& t : triangles_)
        if (std::max({t.x, t.y, t.z}) >= rest.positions.size())
            throw InvalidInput("mesh", "a triangle names a vertex that is not there", "check the mesh");
    places_ = placesOf(rest.positions);
    edgesOf_.assign(triangles_.size(), glm::ivec3(-1));
    struct Side {
        std::uint32_t triangle;
        int corner;
    };
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Side>> sides;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const auto key = std::minmax(places_[triangles_[t][k]], places_[triangles_[t][(k + 1) % 3]]);
            if (key.first != key.second) sides[key].push_back({t, k});
        }
    for (const auto& [key, beside] : sides) {
        links_.push_back({key.first, key.second, glm::distance(rest.positions[key.first], rest.positions[key.second])});
        if (beside.size() != 2) continue;
        const Side& left = beside[0];
        const std::uint32_t a = triangles_[left.triangle][left.corner];
        const std::uint32_t b = triangles_[left.triangle][(left.corner + 1) % 3];
        if (places_[triangles_[beside[1].triangle][beside[1].corner]] == places_[a]) continue; // one of them is flipped
        for (const Side& side : beside) edgesOf_[side.triangle][side.corner] = static_cast<int>(edges_.size());
        edges_.push_back({a, b, left.triangle, beside[1].triangle});
    }
}

// What the walks of one shape need.
struct CreaseFinder::Turning {
    Turning(const CreaseFinder& finder, std::span<const glm::vec3> shape) : positions(shape) {
        normals.reserve(finder.triangles_.size());
        for (const glm::uvec3& t : finder.triangles_)
            normals.push_back(unit(glm::cross(shape[t.y] - shape[t.x], shape[t.z] - shape[t.x])));
        for (const Edge& edge : finder.edges_) {
            directions.push_back(unit(shape[edge.b] - shape[edge.a]));
            const glm::vec3& left = normals[edge.left];
            const glm::vec3& right = normals[edge.right];
            const float sine = glm::dot(glm::cross(left, right), directions.back());
            const float cosine = glm::dot(left, right);
            angles.push_back(left == glm::vec3(0.0F) || right == glm::vec3(0.0F) ? 0.0F : std::atan2(sine, cosine));
        }
    }
    std::span<const glm::vec3> positions;
    std::vector<glm::vec3> normals;    ///< of triangles
    std::vector<glm::vec3> directions; ///< of edges
    std::vector<float> angles;         ///< of edges, positive on a ridge
};

// A straight walk over the surface, away from an edge.
class CreaseFinder::Walk {
public:
    Walk(const CreaseFinder& finder, const Turning& turning, float radius)
        : finder_(finder), turning_(turning), radius_(radius) {}

    // Calls visit(edge, distance, cosine between it and the first edge) for what is crossed on both sides.
    template <class Visit> void across(std::size_t edge, const Visit& visit) const {
        const Edge& e = finder_.edges_[edge];
        for (const std::uint32_t triangle : {e.left, e.right}) away(edge, triangle, visit);
    }

private:
    template <class Visit> void away(std::size_t edge, std::uint32_t triangle, const Visit& visit) const {
        const auto& shape = turning_.positions;
        const Edge& first = finder_.edges_[edge];
        glm::vec3 at = 0.5F * (shape[first.a] + shape[first.b]);
        glm::vec3 direction = inwards(edge, triangle);
        float gone = 0.0F;
        for (int step = 0; step < kMostSteps; ++step) {
            const auto [next, way] = exit(edge, triangle, at, direction);
            gone += way;
            if (next < 0 || !(gone < radius_)) return;
            at += way * direction;
            const auto crossed = static_cast<std::size_t>(next);
            const glm::vec3 along = glm::cross(turning_.normals[triangle], direction);
            if (std::abs(turning_.angles[crossed]) > kSharp) return; // that is a fold of its own
            visit(crossed, gone, std::abs(glm::dot(along, turning_.directions[crossed])));
            // Straight on: the share along the crossed edge stays, that across it goes on in the next triangle.
            const glm::vec3& line = turning_.directions[crossed];
            const float share = glm::dot(direction, line);
            const Edge& e = finder_.edges_[crossed];
            triangle = e.left == triangle ? e.right : e.left;
            direction =
                unit(share * line + std::sqrt(std::max(1.0F - share * share, 0.0F)) * inwards(crossed, triangle));
            edge = crossed;
        }
    }

    // Across an edge into one of its triangles.
    [[nodiscard]] glm::vec3 inwards(std::size_t edge, std::uint32_t triangle) const {
        const glm::vec3 left = glm::cross(turning_.normals[triangle], turning_.directions[edge]);
        return finder_.edges_[edge].left == triangle ? left : -left;
    }

    // The edge through which a ray leaves a triangle (-1: the border, or none), and the way to it.
    [[nodiscard]] std::pair<int, float> exit(std::size_t entry, std::uint32_t triangle, const glm::vec3& at,
                                             const glm::vec3& direction) const {
        const glm::uvec3& t = finder_.triangles_[triangle];
        std::pair<int, float> best{-1, radius_};
        for (int k = 0; k < 3; ++k) {
            const int edge = finder_.edgesOf_[triangle][k];
            if (edge == static_cast<int>(entry)) continue;
            const glm::vec3& a = turning_.positions[t[k]];
            const glm::vec3& b = turning_.positions[t[(k + 1) % 3]];
            const glm::vec3 inside = glm::cross(turning_.normals[triangle], b - a);
            const float towards = -glm::dot(direction, inside);
            if (!(towards > 0.0F)) continue;
            const float way = std::max(glm::dot(at - a, inside) / towards, 0.0F);
            if (way < best.second) best = {edge, way};
        }
        return best;
    }

    const CreaseFinder& finder_;
    const Turning& turning_;
    float radius_;
};

// The turning around each edge, and the same with more weight for what is near.
struct CreaseFinder::Sums {
    std::vector<float> whole, near;
};

CreaseFinder::Sums CreaseFinder::sumsOf(const Turning& turning, float radius) const {
    const Walk walk(*this, turning, radius);
    Sums sums{turning.angles, turning.angles};
    for (std::size_t e = 0; e < edges_.size(); ++e) {
        if (!(std::abs(turning.angles[e]) > kFlat)) continue;
        walk.across(e, [&](std::size_t crossed, float distance, float along) {
            sums.whole[e] += along * turning.angles[crossed];
            sums.near[e] += along * turning.angles[crossed] * (1.0F - distance / radius);
        });
    }
    return sums;
}

// Of edges along one bend, the one with the most turning near it.
bool CreaseFinder::isMiddle(const Turning& turning, const std::vector<float>& near, float radius,
                            std::size_t edge) const {
    bool middle = true;
    Walk(*this, turning, radius).across(edge, [&](std::size_t other, float, float along) {
        const bool stronger =
            std::abs(near[other]) > std::abs(near[edge]) || (near[other] == near[edge] && other < edge);
        if (along > kAlong && near[other] * near[edge] > 0.0F && stronger) middle = false;
    });
    return middle;
}

std::vector<Crease> CreaseFinder::find(std::span<const glm::vec3> positions, const CreaseSearch& search) const {
    const Turning turning(*this, positions);
    const auto radius = static_cast<float>(search.radius);
    const auto threshold = static_cast<float>(search.threshold.inRadians());
    const Sums sums = sumsOf(turning, radius);
    std::vector<Crease> creases;
    std::vector<bool> sharp;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
        const float own = turning.angles[e];
        const bool alone = std::abs(own) >= kOwnShare * std::abs(sums.whole[e]);
        const float angle = alone && std::abs(own) > std::abs(sums.whole[e]) ? own : sums.whole[e];
        if (!(std::abs(own) > kFlat) || !(std::abs(angle) >= threshold)) continue;
        if (!alone && !isMiddle(turning, sums.near, radius, e)) continue;
        creases.push_back({{edges_[e].a, edges_[e].b}, {edges_[e].left, edges_[e].right}, Angle::radians(angle)});
        sharp.push_back(alone);
    }
    return withoutScraps(positions, std::move(creases), sharp, kShortest * search.radius);
}

// Where a bend meets a border, single edges beside its middle may seem folds of their own.
std::vector<Crease> CreaseFinder::withoutScraps(std::span<const glm::vec3> positions, std::vector<Crease> creases,
                                                const std::vector<bool>& sharp, double shortest) const {
    DisjointSets chains(positions.size());
    for (const Crease& crease : creases) chains.join(places_[crease.vertices[0]], places_[crease.vertices[1]]);
    std::map<std::uint32_t, double> lengths;
    for (std::size_t i = 0; i < creases.size(); ++i) {
        const auto& [a, b] = creases[i].vertices;
        lengths[chains.find(places_[a])] +=
            sharp[i] ? 2.0 * shortest : static_cast<double>(glm::distance(positions[a], positions[b]));
    }
    std::erase_if(creases,
                  [&](const Crease& crease) { return lengths[chains.find(places_[crease.vertices[0]])] < shortest; });
    return creases;
}

// Each round a vertex takes over from its neighbours, the more the nearer they are; some rounds spread by the radius.
std::vector<glm::vec3> CreaseFinder::softNormals(std::span<const glm::vec3> positions, double radius) const {
    std::vector<glm::vec3> normals(positions.size(), glm::vec3(0.0F));
    for (const glm::uvec3& t : triangles_) {
        const glm::vec3 area = glm::cross(positions[t.y] - positions[t.x], positions[t.z] - positions[t.x]);
        for (int k = 0; k < 3; ++k) normals[places_[t[k]]] += area;
    }
    for (glm::vec3& normal : normals) normal = unit(normal);
    const float reach = static_cast<float>(radius) / std::sqrt(static_cast<float>(kSofteningRounds)) * 2.0F;
    std::vector<glm::vec3> sums;
    for (int round = 0; round < kSofteningRounds; ++round) {
        sums = normals;
        for (const Link& link : links_) {
            const float share = link.length / reach;
            const float weight = std::exp(-share * share);
            sums[link.a] += weight * normals[link.b];
            sums[link.b] += weight * normals[link.a];
        }
        for (std::size_t i = 0; i < normals.size(); ++i) normals[i] = unit(sums[i]);
    }
    for (std::size_t i = 0; i < normals.size(); ++i) normals[i] = normals[places_[i]];
    return normals;
}

CreaseStrips creaseStrips(std::span<const Crease> creases, std::span<const glm::uvec3> triangles,
                          std::span<const glm::vec3> positions, double width, Angle threshold) {
    CreaseStrips strips;
    const auto half = static_cast<float>(0.5 * width);
    for (const Crease& crease : creases) {
        const glm::vec3 ends[2] = {positions[crease.vertices[0]], positions[crease.vertices[1]]};
        const double above = (std::abs(crease.angle.inRadians()) / std::max(threshold.inRadians(), 1e-6)) - 1.0;
        const auto strength = static_cast<float>(std::clamp(2.0 * above, 0.0, 1.0));
        for (int side = 0; side < 2; ++side) {
            const glm::uvec3& t = triangles[crease.triangles[static_cast<std::size_t>(side)]];
            const glm::vec3 normal = unit(glm::cross(positions[t.y] - positions[t.x], positions[t.z] - positions[t.x]));
            const glm::vec3 along = unit(ends[1] - ends[0]);
            const glm::vec3 out = (side == 0 ? half : -half) * glm::cross(normal, along);
            const auto first = static_cast<std::uint32_t>(strips.positions.size());
            for (int end = 0; end < 2; ++end)
                for (const float across : {0.0F, 1.0F}) {
                    strips.positions.push_back(ends[end] + across * out);
                    strips.normals.push_back(normal);
                    strips.across.emplace_back(across, strength);
                    strips.vertices.push_back(crease.vertices[static_cast<std::size_t>(end)]);
                }
            const std::uint32_t near = side == 0 ? 2 : 1;
            const std::uint32_t far = 3 - near;
            strips.triangles.push_back({first, first + near, first + far});
            strips.triangles.push_back({first + far, first + near, first + 3});
        }
    }
    return strips;
}

} // namespace lumorph
