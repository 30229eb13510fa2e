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

constexpr auto kReached = static_cast<float>(CreaseFinder::kRadius);
constexpr std::size_t kMostForRidges = 16'000; // triangles: sums over neighbourhoods grow with the square
constexpr int kMostSteps = 64;                 // of one walk
constexpr float kFlat = 1e-4F;                 // radians: what turns less is no part of a fold
constexpr float kOwnShare = 0.75F;             // an edge that does this much of the turning is a fold by itself
constexpr float kSharp = 0.5F;                 // radians of turning at one edge, at which a walk ends
constexpr double kShortest = 2.0;              // radii that a fold runs at least, unless it is sharp
constexpr float kAtVertex = 0.01F;             // of an edge's length
constexpr int kStraightenings = 6;
constexpr float kLifted = 0.0004F; // metres, so that a straightened line does not sink into triangles beside its own
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
    if (triangles_.size() > kMostForRidges) return;
    ridges_ = std::make_unique<const RidgeTracer>(rest.positions, triangles_, places_, edges_,
                                                  static_cast<float>(kRadius), kSharp);
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
    /// Adds up `angles` of what it crosses.
    Walk(const CreaseFinder& finder, const Turning& turning, std::span<const float> angles)
        : finder_(finder), turning_(turning), angles_(angles) {}

    /// The turning on both sides of an edge, as across it; without its own.
    [[nodiscard]] float across(std::size_t edge) const {
        const Edge& e = finder_.edges_[edge];
        const glm::vec3 middle = 0.5F * (turning_.positions[e.a] + turning_.positions[e.b]);
        return away(static_cast<int>(edge), e.left, middle, inwards(edge, e.left)) +
               away(static_cast<int>(edge), e.right, middle, inwards(edge, e.right));
    }
    /// The turning from a place in a triangle in a direction and in the opposite one.
    [[nodiscard]] float across(std::uint32_t triangle, const glm::vec3& at, const glm::vec3& direction) const {
        const glm::vec3& normal = turning_.normals[triangle];
        const glm::vec3 out = unit(direction - glm::dot(direction, normal) * normal);
        return away(-1, triangle, at, out) + away(-1, triangle, at, -out);
    }

private:
    [[nodiscard]] float away(int edge, std::uint32_t triangle, glm::vec3 at, glm::vec3 direction) const {
        float gone = 0.0F, sum = 0.0F;
        for (int step = 0; step < kMostSteps; ++step) {
            const auto [next, way] = exit(edge, triangle, at, direction);
            gone += way;
            if (next < 0 || !(gone < kReached)) break;
            at += way * direction;
            const auto crossed = static_cast<std::size_t>(next);
            if (std::abs(turning_.angles[crossed]) > kSharp) break; // that is a fold of its own
            const glm::vec3 along = glm::cross(turning_.normals[triangle], direction);
            sum += std::abs(glm::dot(along, turning_.directions[crossed])) * angles_[crossed];
            // Straight on: the share along the crossed edge stays, that across it goes on in the next triangle.
            const glm::vec3& line = turning_.directions[crossed];
            const float share = glm::dot(direction, line);
            const Edge& e = finder_.edges_[crossed];
            triangle = e.left == triangle ? e.right : e.left;
            direction =
                unit(share * line + std::sqrt(std::max(1.0F - share * share, 0.0F)) * inwards(crossed, triangle));
            edge = next;
        }
        return sum;
    }

    // Across an edge into one of its triangles.
    [[nodiscard]] glm::vec3 inwards(std::size_t edge, std::uint32_t triangle) const {
        const glm::vec3 left = glm::cross(turning_.normals[triangle], turning_.directions[edge]);
        return finder_.edges_[edge].left == triangle ? left : -left;
    }

    // The edge through which a ray leaves a triangle (-1: the border, or none), and the way to it.
    [[nodiscard]] std::pair<int, float> exit(int entry, std::uint32_t triangle, const glm::vec3& at,
                                             const glm::vec3& direction) const {
        const glm::uvec3& t = finder_.triangles_[triangle];
        std::pair<int, float> best{-1, kReached};
        for (int k = 0; k < 3; ++k) {
            const int edge = finder_.edgesOf_[triangle][k];
            if (edge == entry) continue;
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
    std::span<const float> angles_;
};

std::vector<float> CreaseFinder::turningAround(const Turning& turning) const {
    const Walk walk(*this, turning, turning.angles);
    std::vector<float> sums = turning.angles;
    for (std::size_t e = 0; e < edges_.size(); ++e)
        if (std::abs(turning.angles[e]) > kFlat) sums[e] += walk.across(e);
    return sums;
}

// An edge that is turned against a bend crosses little of it: what its triangles turn at their other edges tells.
float CreaseFinder::turningBeside(const Turning& turning, std::size_t edge) const {
    float sum = std::abs(turning.angles[edge]);
    for (const std::uint32_t triangle : {edges_[edge].left, edges_[edge].right})
        for (int k = 0; k < 3; ++k)
            if (const int other = edgesOf_[triangle][k]; other >= 0 && other != static_cast<int>(edge))
                sum += std::abs(turning.angles[static_cast<std::size_t>(other)]);
    return sum;
}

std::vector<float> CreaseFinder::addEdges(const Turning& turning, float threshold, std::vector<Piece>& pieces) const {
    std::vector<float> soft = turning.angles;
    const std::vector<float> sums = turningAround(turning);
    for (std::size_t e = 0; e < edges_.size(); ++e) {
        const float own = turning.angles[e];
        if (!(std::abs(own) > kFlat) || std::abs(own) < kOwnShare * std::abs(sums[e])) continue;
        const float angle = std::abs(own) > std::abs(sums[e]) ? own : sums[e];
        const bool sharp = std::abs(own) > kSharp;
        if (!sharp && std::abs(own) < kOwnShare * turningBeside(turning, e)) continue;
        if (sharp || std::abs(angle) >= threshold) soft[e] = 0.0F;
        if (std::abs(angle) < threshold) continue;
        const auto [a, b, left, right] = edges_[e];
        pieces.push_back({{{turning.positions[a], turning.positions[b]},
                           {turning.normals[left], turning.normals[right]},
                           {a, b},
                           Angle::radians(angle)},
                          {places_[a], places_[b]},
                          sharp});
    }
    return soft;
}

void CreaseFinder::addRidges(const Turning& turning, std::span<const float> soft, float threshold,
                             std::vector<Piece>& pieces) const {
    if (!ridges_) return;
    const Walk walk(*this, turning, soft);
    for (const RidgePiece& ridge : ridges_->trace(turning.positions, turning.normals, soft)) {
        const float angle = walk.across(ridge.triangle, 0.5F * (ridge.ends[0] + ridge.ends[1]), ridge.across);
        if (std::abs(angle) < threshold) continue;
        Piece piece{{ridge.ends, {}, {}, Angle::radians(angle)}, {}, false};
        piece.crease.normals.fill(turning.normals[ridge.triangle]);
        piece.crease.vertices = ridge.nearest;
        for (std::size_t k = 0; k < 2; ++k) {
            // A line through a vertex may come to it along any of its edges.
            const bool inside = ridge.parts[k] > kAtVertex && ridge.edges[k] >= 0;
            piece.ends[k] =
                inside ? static_cast<std::uint32_t>(places_.size()) + static_cast<std::uint32_t>(ridge.edges[k])
                       : places_[ridge.nearest[k]];
        }
        pieces.push_back(piece);
    }
}

// Lines through coarse triangles are crooked: each end goes halfway to the middle of those that it is joined to.
void CreaseFinder::straighten(std::span<Piece> ridges) {
    struct Place {
        glm::vec3 at{0.0F}, sum{0.0F};
        float count = 0.0F;
    };
    std::map<std::uint32_t, Place> places;
    for (const Piece& piece : ridges)
        for (std::size_t k = 0; k < 2; ++k) places[piece.ends[k]].at = piece.crease.ends[k];
    for (int round = 0; round < kStraightenings; ++round) {
        for (auto& [number, place] : places) place.sum = glm::vec3(place.count = 0.0F);
        for (const Piece& piece : ridges)
            for (std::size_t k = 0; k < 2; ++k) {
                Place& place = places[piece.ends[k]];
                place.sum += places[piece.ends[1 - k]].at;
                place.count += 1.0F;
            }
        for (auto& [number, place] : places) // a line's own ends stay where they are
            if (place.count > 1.0F) place.at = glm::mix(place.at, place.sum / place.count, 0.5F);
    }
    for (Piece& piece : ridges)
        for (std::size_t k = 0; k < 2; ++k)
            piece.crease.ends[k] = places[piece.ends[k]].at + kLifted * piece.crease.normals[k];
}

std::vector<Crease> CreaseFinder::find(std::span<const glm::vec3> positions, Angle threshold) const {
    const Turning turning(*this, positions);
    const auto least = static_cast<float>(threshold.inRadians());
    std::vector<Piece> pieces;
    const std::vector<float> soft = addEdges(turning, least, pieces);
    const std::size_t edges = pieces.size();
    addRidges(turning, soft, least, pieces);
    straighten(std::span(pieces).subspan(edges));
    return withoutScraps(pieces);
}

// A bend that ends, or meets a border, leaves pieces that are no folds.
std::vector<Crease> CreaseFinder::withoutScraps(const std::vector<Piece>& pieces) const {
    DisjointSets chains(places_.size() + edges_.size());
    for (const Piece& piece : pieces) chains.join(piece.ends[0], piece.ends[1]);
    std::map<std::uint32_t, double> lengths;
    for (const Piece& piece : pieces)
        lengths[chains.find(piece.ends[0])] +=
            piece.sharp ? kShortest * kRadius
                        : static_cast<double>(glm::distance(piece.crease.ends[0], piece.crease.ends[1]));
    std::vector<Crease> creases;
    for (const Piece& piece : pieces)
        if (lengths[chains.find(piece.ends[0])] >= kShortest * kRadius) creases.push_back(piece.crease);
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

CreaseStrips creaseStrips(std::span<const Crease> creases, double width, Angle threshold) {
    CreaseStrips strips;
    const auto half = static_cast<float>(0.5 * width);
    for (const Crease& crease : creases) {
        const auto& ends = crease.ends;
        const double above = (std::abs(crease.angle.inRadians()) / std::max(threshold.inRadians(), 1e-6)) - 1.0;
        const auto strength = static_cast<float>(std::clamp(2.0 * above, 0.0, 1.0));
        for (int side = 0; side < 2; ++side) {
            const glm::vec3& normal = crease.normals[static_cast<std::size_t>(side)];
            const glm::vec3 along = unit(ends[1] - ends[0]);
            const glm::vec3 out = (side == 0 ? half : -half) * glm::cross(normal, along);
            const auto first = static_cast<std::uint32_t>(strips.positions.size());
            for (std::size_t end = 0; end < 2; ++end)
                for (const float across : {0.0F, 1.0F}) {
                    strips.positions.push_back(ends[end] + across * out);
                    strips.normals.push_back(normal);
                    strips.across.emplace_back(across, strength);
                    strips.vertices.push_back(crease.vertices[end]);
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
