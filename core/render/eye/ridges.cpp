#include "core/render/eye/ridges.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/geometry/disjoint_sets.h"

namespace lumorph {
namespace {

constexpr float kSpread = 0.8F;   // of the radius: a fold's curvature at its middle is then its angle over two radii
constexpr float kReach = 2.2F;    // spreads, beyond which a neighbour counts for nothing
constexpr float kTogether = 0.5F; // cosine, up to which directions at a triangle's corners belong to one fold

glm::vec3 areaOf(std::span<const glm::vec3> positions, const glm::uvec3& t) {
    return 0.5F * glm::cross(positions[t.y] - positions[t.x], positions[t.z] - positions[t.x]);
}

glm::vec3 unitOf(const glm::vec3& v) {
    const float length = glm::length(v);
    return length > 0.0F ? v / length : glm::vec3(0.0F);
}

/// Of the triangles' planes: between a pair's normals, unsigned.
float angleBetween(const glm::vec3& one, const glm::vec3& other) {
    return std::acos(std::clamp(glm::dot(unitOf(one), unitOf(other)), -1.0F, 1.0F));
}

/// The gradient of a function that is linear on a triangle.
glm::vec3 gradientOn(const std::array<glm::vec3, 3>& corners, const glm::vec3& values) {
    const glm::vec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const float square = glm::dot(normal, normal);
    if (!(square > 0.0F)) return glm::vec3(0.0F);
    glm::vec3 sum(0.0F);
    for (int k = 0; k < 3; ++k)
        sum += values[k] * glm::cross(normal, corners[static_cast<std::size_t>((k + 2) % 3)] -
                                                  corners[static_cast<std::size_t>((k + 1) % 3)]);
    return sum / square;
}

/// An edge's or a triangle's middle, and the surface that it belongs to.
struct Place {
    std::uint32_t number;
    std::uint32_t surface;
    glm::vec3 middle;
};

/// Finds what lies near, weighed by a Gaussian.
class Neighbourhood {
public:
    Neighbourhood(const std::vector<Place>& places, float spread) : places_(places), spread_(spread) {
        for (std::size_t i = 0; i < places.size(); ++i) cells_[cellOf(places[i].middle)].push_back(i);
    }

    [[nodiscard]] std::vector<RidgeTracer::Share> around(const glm::vec3& at, std::uint32_t surface) const {
        std::vector<RidgeTracer::Share> found;
        const Cell middle = cellOf(at);
        for (int i = 0; i < 27; ++i) {
            const auto cell = cells_.find({middle[0] + i % 3 - 1, middle[1] + i / 3 % 3 - 1, middle[2] + i / 9 - 1});
            if (cell == cells_.end()) continue;
            for (const std::size_t k : cell->second) {
                const float away = glm::distance(at, places_[k].middle) / spread_;
                if (places_[k].surface == surface && away < kReach)
                    found.push_back({places_[k].number, std::exp(-0.5F * away * away)});
            }
        }
        return found;
    }

private:
    using Cell = std::array<int, 3>;
    [[nodiscard]] Cell cellOf(const glm::vec3& at) const {
        const glm::vec3 cell = glm::floor(at / (kReach * spread_));
        return {static_cast<int>(cell.x), static_cast<int>(cell.y), static_cast<int>(cell.z)};
    }

    const std::vector<Place>& places_;
    float spread_;
    std::map<Cell, std::vector<std::size_t>> cells_;
};

} // namespace

RidgeTracer::RidgeTracer(std::span<const glm::vec3> rest, std::span<const glm::uvec3> triangles,
                         std::span<const std::uint32_t> places, std::span<const MeshEdge> edges, float radius,
                         float sharp)
    : triangles_(triangles.begin(), triangles.end()), edges_(edges.begin(), edges.end()) {
    std::vector<glm::vec3> areas;
    for (const glm::uvec3& t : triangles_) areas.push_back(areaOf(rest, t));
    DisjointSets surfaces(triangles_.size());
    edgesOf_.assign(triangles_.size(), glm::ivec3(-1));
    for (std::size_t e = 0; e < edges_.size(); ++e) {
        for (const std::uint32_t triangle : {edges_[e].left, edges_[e].right})
            for (int k = 0; k < 3; ++k) {
                const auto ends =
                    std::minmax(places[triangles_[triangle][k]], places[triangles_[triangle][(k + 1) % 3]]);
                if (ends == std::minmax(places[edges_[e].a], places[edges_[e].b]))
                    edgesOf_[triangle][k] = static_cast<int>(e);
            }
        if (angleBetween(areas[edges_[e].left], areas[edges_[e].right]) <= sharp)
            surfaces.join(edges_[e].left, edges_[e].right);
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> numbers;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        glm::uvec3 nodes;
        for (int k = 0; k < 3; ++k) {
            const auto [found, isNew] = numbers.try_emplace({places[triangles_[t][k]], surfaces.find(t)},
                                                            static_cast<std::uint32_t>(nodes_.size()));
            if (isNew) nodes_.push_back({triangles_[t][k], {}, {}, {}});
            nodes[k] = found->second;
            nodes_[nodes[k]].around.push_back(t);
        }
        nodesOf_.push_back(nodes);
    }
    std::vector<Place> ofEdges, ofTriangles;
    for (std::uint32_t e = 0; e < edges_.size(); ++e)
        if (surfaces.find(edges_[e].left) == surfaces.find(edges_[e].right))
            ofEdges.push_back({e, surfaces.find(edges_[e].left), 0.5F * (rest[edges_[e].a] + rest[edges_[e].b])});
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        const glm::uvec3& c = triangles_[t];
        ofTriangles.push_back({t, surfaces.find(t), (rest[c.x] + rest[c.y] + rest[c.z]) / 3.0F});
    }
    const Neighbourhood edgesNear(ofEdges, kSpread * radius), trianglesNear(ofTriangles, kSpread * radius);
    for (Node& node : nodes_) {
        const auto surface = surfaces.find(node.around.front());
        node.edges = edgesNear.around(rest[node.vertex], surface);
        node.triangles = trianglesNear.around(rest[node.vertex], surface);
    }
}

std::vector<RidgeTracer::Bend> RidgeTracer::bendsOf(std::span<const glm::vec3> positions,
                                                    std::span<const glm::vec3> normals,
                                                    std::span<const float> angles) const {
    std::vector<Bend> bends(nodes_.size());
    std::vector<float> areas;
    for (const glm::uvec3& t : triangles_) areas.push_back(glm::length(areaOf(positions, t)));
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
        glm::vec3 normal(0.0F);
        float area = 0.0F;
        for (const Share& share : nodes_[n].triangles) {
            const float part = share.weight * areas[share.of];
            area += part;
            normal += part * normals[share.of];
        }
        normal = unitOf(normal);
        if (!(area > 0.0F) || normal == glm::vec3(0.0F)) continue;
        // The tensor in the tangent plane: xx, yy, xy.
        const glm::vec3 x = unitOf(
            glm::cross(normal, std::abs(normal.x) < 0.7F ? glm::vec3(1.0F, 0.0F, 0.0F) : glm::vec3(0.0F, 1.0F, 0.0F)));
        const glm::vec3 y = glm::cross(normal, x);
        glm::vec3 tensor(0.0F);
        for (const Share& share : nodes_[n].edges) {
            const glm::vec3 way = positions[edges_[share.of].b] - positions[edges_[share.of].a];
            const float length = glm::length(way);
            if (!(length > 0.0F)) continue;
            const float p = glm::dot(way, x), q = glm::dot(way, y);
            tensor += share.weight * angles[share.of] / length * glm::vec3(p * p, q * q, p * q);
        }
        tensor /= area;
        const float mean = 0.5F * (tensor.x + tensor.y), half = 0.5F * (tensor.x - tensor.y);
        const float root = std::hypot(half, tensor.z);
        const float larger = mean < 0.0F ? mean - root : mean + root;
        // Turning is summed up along its edges, so that this eigenvector runs along the fold.
        const float along = 0.5F * std::atan2(tensor.z, half) + (mean < 0.0F ? 1.57079633F : 0.0F);
        bends[n].most = std::abs(larger);
        bends[n].across = -std::sin(along) * x + std::cos(along) * y;
    }
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
        glm::vec3 gradient(0.0F);
        float area = 0.0F;
        for (const std::uint32_t t : nodes_[n].around) {
            const glm::uvec3& c = triangles_[t];
            const float part = areas[t];
            const glm::uvec3& k = nodesOf_[t];
            gradient += part * gradientOn({positions[c.x], positions[c.y], positions[c.z]},
                                          {bends[k.x].most, bends[k.y].most, bends[k.z].most});
            area += part;
        }
        if (area > 0.0F) bends[n].growth = glm::dot(gradient / area, bends[n].across);
    }
    return bends;
}

void RidgeTracer::addPiece(std::uint32_t triangle, std::span<const glm::vec3> positions, const std::vector<Bend>& bends,
                           std::vector<RidgePiece>& pieces) const {
    const glm::uvec3& corners = triangles_[triangle];
    std::array<Bend, 3> bend;
    for (int k = 0; k < 3; ++k) {
        Bend& one = bend[static_cast<std::size_t>(k)] = bends[nodesOf_[triangle][k]];
        const float turned = glm::dot(one.across, bend[0].across);
        if (std::abs(turned) < kTogether) return; // no single fold, or none at all
        if (turned > 0.0F) continue;
        one.across = -one.across;
        one.growth = -one.growth;
    }
    RidgePiece piece{triangle, {}, {}, {}, {}, bend[0].across + bend[1].across + bend[2].across};
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        if ((bend[k].growth < 0.0F) == (bend[next].growth < 0.0F)) continue;
        const std::uint32_t from = corners[static_cast<int>(k)], to = corners[static_cast<int>(next)];
        const float part = bend[k].growth / (bend[k].growth - bend[next].growth);
        piece.ends[count] = glm::mix(positions[from], positions[to], part);
        piece.edges[count] = edgesOf_[triangle][static_cast<int>(k)];
        piece.nearest[count] = part < 0.5F ? from : to;
        piece.parts[count] = std::min(part, 1.0F - part);
        ++count;
    }
    if (count != 2) return;
    // The curvature grows towards a line where it is largest.
    float towards = 0.0F;
    const glm::vec3 middle = 0.5F * (piece.ends[0] + piece.ends[1]);
    for (std::size_t k = 0; k < 3; ++k)
        towards += bend[k].growth * glm::dot(bend[k].across, middle - positions[corners[static_cast<int>(k)]]);
    if (towards > 0.0F) pieces.push_back(piece);
}

std::vector<RidgePiece> RidgeTracer::trace(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                                           std::span<const float> angles) const {
    const std::vector<Bend> bends = bendsOf(positions, normals, angles);
    std::vector<RidgePiece> pieces;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) addPiece(t, positions, bends, pieces);
    return pieces;
}

} // namespace lumorph
