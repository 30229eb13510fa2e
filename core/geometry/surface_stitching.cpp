#include "core/geometry/surface_stitching.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/geometry/crowded_edges.h"
#include "core/geometry/disjoint_sets.h"
#include "core/geometry/hole_filling.h"
#include "core/geometry/mesh_topology.h"

namespace lumorph {
namespace {

constexpr std::uint32_t kNoPartner = MeshTopology::kNone;

std::uint64_t directedKey(std::uint32_t a, std::uint32_t b) noexcept { return (std::uint64_t{a} << 32U) | b; }

class Stitcher {
public:
    Stitcher(const TriangleMesh& mesh, std::size_t maxHoleEdges)
        : mesh_(mesh), topology_(meshTopology(mesh)), maxHoleEdges_(std::min(maxHoleEdges, kMaxHoleEdges)),
          corners_(3 * mesh.triangles.size()), pieces_(mesh.triangles.size()) {}

    StitchedSurface stitch() {
        faceOneWay();
        joinCrowdedEdges(mesh_, topology_);
        joinCorners();
        fillHoles();
        collect();
        return std::move(result_);
    }

private:
    /// Goes over each piece from triangle to neighbour; then turns whichever part is smaller. Where a
    /// piece cannot be made to agree (a Moebius strip), it is cut.
    void faceOneWay() {
        std::vector<signed char> side(mesh_.triangles.size(), 0);
        std::vector<bool> turned(mesh_.triangles.size(), false);
        std::vector<std::uint32_t> piece;
        for (std::uint32_t seed = 0; seed < mesh_.triangles.size(); ++seed) {
            if (side[seed] != 0) continue;
            side[seed] = 1;
            piece.assign(1, seed);
            std::size_t against = 0;
            for (std::size_t i = 0; i < piece.size(); ++i)
                for (std::uint32_t h = 3 * piece[i]; h < 3 * piece[i] + 3; ++h) against += visit(h, side, piece);
            const signed char minority = 2 * against > piece.size() ? 1 : -1;
            for (const std::uint32_t t : piece)
                if (side[t] == minority) {
                    turn(t);
                    turned[t] = true;
                }
        }
        // Half-edges k of a turned triangle are now called 2 - k.
        const auto rename = [&](std::uint32_t& h) { h = turned[h / 3] ? 6 * (h / 3) + 2 - h : h; };
        std::ranges::for_each(cut_, rename);
        for (std::vector<std::uint32_t>& edge : topology_.crowdedEdges) std::ranges::for_each(edge, rename);
    }

    /// Looks over one edge; 1 when the neighbour is new and runs against the first triangle.
    std::size_t visit(std::uint32_t h, std::vector<signed char>& side, std::vector<std::uint32_t>& piece) {
        const std::uint32_t other = topology_.partner[h];
        if (other == kNoPartner) return 0;
        const bool agree = topology_.startPlace(mesh_, h) != topology_.startPlace(mesh_, other);
        const auto wanted = static_cast<signed char>(agree ? side[h / 3] : -side[h / 3]);
        signed char& neighbour = side[other / 3];
        if (neighbour == 0) {
            neighbour = wanted;
            piece.push_back(other / 3);
            return wanted < 0 ? 1 : 0;
        }
        if (neighbour != wanted) {
            topology_.partner[h] = topology_.partner[other] = kNoPartner;
            cut_.push_back(h);
            cut_.push_back(other);
        }
        return 0;
    }

    /// Reverses a triangle along with its half-edges.
    void turn(std::uint32_t t) {
        std::swap(mesh_.triangles[t].y, mesh_.triangles[t].z);
        std::swap(topology_.partner[3 * t], topology_.partner[3 * t + 2]);
        for (const std::uint32_t h : {3 * t, 3 * t + 2})
            if (const std::uint32_t other = topology_.partner[h]; other != kNoPartner) topology_.partner[other] = h;
        ++result_.turnedTriangles;
    }

    void joinCorners() {
        for (std::uint32_t h = 0; h < topology_.partner.size(); ++h) {
            const std::uint32_t other = topology_.partner[h];
            if (other == kNoPartner || other < h) continue;
            pieces_.join(h / 3, other / 3);
            corners_.join(h, nextInTriangle(other));
            corners_.join(nextInTriangle(h), other);
        }
    }

    [[nodiscard]] std::uint32_t place(std::uint32_t corner) const noexcept {
        return topology_.places[vertexAt(mesh_, corner)];
    }
    [[nodiscard]] const glm::vec3& position(std::uint32_t corner) const noexcept {
        return mesh_.positions[vertexAt(mesh_, corner)];
    }

    void fillHoles() {
        // Each vertex is the tip of one fan of triangles, so at most one open half-edge starts there.
        std::unordered_map<std::uint32_t, std::uint32_t> openFrom;
        for (std::uint32_t h = 0; h < topology_.partner.size(); ++h)
            if (topology_.partner[h] == kNoPartner) openFrom[corners_.find(h)] = h;
        if (openFrom.empty()) return;
        for (std::uint32_t h = 0; h < topology_.partner.size(); ++h)
            edges_.insert(directedKey(place(h), place(nextInTriangle(h))));
        undecided_.insert(cut_.begin(), cut_.end());
        for (const std::vector<std::uint32_t>& edge : topology_.crowdedEdges)
            undecided_.insert(edge.begin(), edge.end());

        for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) members_[pieces_.find(t)].push_back(t);

        // All rims are followed before the first is filled, as filling may join corners.
        std::vector<std::vector<std::uint32_t>> rims;
        std::unordered_set<std::uint32_t> done;
        for (std::uint32_t h = 0; h < topology_.partner.size(); ++h) {
            if (topology_.partner[h] != kNoPartner || done.contains(h)) continue;
            rims.emplace_back();
            for (std::uint32_t at = h; done.insert(at).second; at = openFrom.at(corners_.find(nextInTriangle(at))))
                rims.back().push_back(at);
        }
        for (const std::vector<std::uint32_t>& rim : rims) splitAndFill(rim);
    }

    /// Holes that touch at a point form one rim that passes there twice: each loop is filled alone.
    void splitAndFill(const std::vector<std::uint32_t>& rim) {
        std::vector<std::uint32_t> path;
        std::unordered_map<std::uint32_t, std::size_t> onPath;
        for (const std::uint32_t h : rim) {
            if (const auto seen = onPath.find(place(h)); seen != onPath.end()) {
                const auto start = path.begin() + static_cast<std::ptrdiff_t>(seen->second);
                corners_.join(*start, h);
                const std::vector<std::uint32_t> loop(start, path.end());
                for (const std::uint32_t gone : loop) onPath.erase(place(gone));
                path.erase(start, path.end());
                fill(loop);
            }
            onPath[place(h)] = path.size();
            path.push_back(h);
        }
        if (!path.empty()) fill(path);
    }

    void fill(const std::vector<std::uint32_t>& loop) {
        if (std::ranges::any_of(loop, [&](std::uint32_t h) { return undecided_.contains(h); })) return;
        if (loop.size() < 3 || loop.size() > maxHoleEdges_ || isFlatSheet(loop.front() / 3)) {
            ++result_.openHoles;
            return;
        }
        // The filling runs against its neighbours.
        const std::vector<std::uint32_t> rim(loop.rbegin(), loop.rend());
        std::vector<glm::vec3> points;
        points.reserve(rim.size());
        for (const std::uint32_t corner : rim) points.push_back(position(corner));
        const auto triangles = fillHole(points, [&](std::size_t i, std::size_t j) {
            return edges_.contains(directedKey(place(rim[i]), place(rim[j]))) ||
                   edges_.contains(directedKey(place(rim[j]), place(rim[i])));
        });
        for (const glm::uvec3& t : triangles) {
            added_.emplace_back(rim[t.x], rim[t.y], rim[t.z]);
            for (const auto& [a, b] : {std::pair(t.x, t.y), std::pair(t.y, t.z), std::pair(t.z, t.x)})
                edges_.insert(directedKey(place(rim[a]), place(rim[b])));
        }
        ++result_.filledHoles;
    }

    /// Filling the rim of a flat piece would only lay a second sheet on the first.
    bool isFlatSheet(std::uint32_t triangle) {
        const std::uint32_t root = pieces_.find(triangle);
        const auto [known, isNew] = flat_.try_emplace(root, false);
        if (!isNew) return known->second;
        const std::vector<std::uint32_t>& members = members_.at(root);
        glm::dvec3 normal(0.0);
        Box box;
        double largest = -1.0;
        for (const std::uint32_t t : members) {
            const glm::dvec3 a(position(3 * t));
            const glm::dvec3 n = glm::cross(glm::dvec3(position(3 * t + 1)) - a, glm::dvec3(position(3 * t + 2)) - a);
            if (glm::length(n) > largest) {
                largest = glm::length(n);
                normal = n;
            }
            for (std::uint32_t c = 3 * t; c < 3 * t + 3; ++c) box.include(position(c));
        }
        const glm::dvec3 origin(position(3 * members.front()));
        const double tolerance = 1e-6 * glm::length(normal) * glm::length(glm::dvec3(box.size()));
        known->second = std::ranges::all_of(members, [&](std::uint32_t t) {
            for (std::uint32_t c = 3 * t; c < 3 * t + 3; ++c)
                if (std::abs(glm::dot(normal, glm::dvec3(position(c)) - origin)) > tolerance) return false;
            return true;
        });
        return known->second;
    }

    /// One vertex for each set of joined corners, in the order the mesh had them. Gives their numbers
    /// by the corner that stands for the set.
    std::vector<std::uint32_t> numberVertices() {
        std::vector<std::uint32_t> first(cornerCount(), kNoPartner); // vertex of the mesh, by set
        for (std::uint32_t c = 0; c < cornerCount(); ++c) {
            std::uint32_t& vertex = first[corners_.find(c)];
            vertex = std::min(vertex, vertexAt(mesh_, c));
        }
        std::vector<std::uint32_t> sets;
        for (std::uint32_t c = 0; c < cornerCount(); ++c)
            if (first[c] != kNoPartner) sets.push_back(c);
        std::ranges::stable_sort(sets, {}, [&](std::uint32_t set) { return first[set]; });
        std::vector<std::uint32_t> number(cornerCount(), kNoPartner);
        for (const std::uint32_t set : sets) {
            number[set] = static_cast<std::uint32_t>(result_.mesh.positions.size());
            result_.mesh.positions.push_back(mesh_.positions[first[set]]);
        }
        return number;
    }

    void collect() {
        TriangleMesh& out = result_.mesh;
        const std::vector<std::uint32_t> number = numberVertices();
        const auto vertex = [&](std::uint32_t corner) { return number[corners_.find(corner)]; };
        for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t)
            out.triangles.emplace_back(vertex(3 * t), vertex(3 * t + 1), vertex(3 * t + 2));
        for (const glm::uvec3& t : added_) out.triangles.emplace_back(vertex(t.x), vertex(t.y), vertex(t.z));

        std::unordered_set<std::uint32_t> used;
        for (std::uint32_t c = 0; c < cornerCount(); ++c) used.insert(vertexAt(mesh_, c));
        result_.mergedVertices = used.size() > out.positions.size() ? used.size() - out.positions.size() : 0;
    }

    [[nodiscard]] std::size_t cornerCount() const noexcept { return 3 * mesh_.triangles.size(); }

    TriangleMesh mesh_;
    MeshTopology topology_;
    std::size_t maxHoleEdges_;
    DisjointSets corners_; ///< corners that are one vertex
    DisjointSets pieces_;  ///< triangles connected over edges
    std::vector<std::uint32_t> cut_;
    std::unordered_set<std::uint32_t> undecided_; ///< half-edges that bound no hole, whatever they seem
    std::unordered_set<std::uint64_t> edges_;     ///< between places, in the direction they run
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> members_; ///< triangles, by piece
    std::unordered_map<std::uint32_t, bool> flat_;                          ///< by piece
    std::vector<glm::uvec3> added_;                                         ///< as corners
    StitchedSurface result_;
};

} // namespace

StitchedSurface stitchSurface(const TriangleMesh& mesh, std::size_t maxHoleEdges) {
    return Stitcher(mesh, maxHoleEdges).stitch();
}

} // namespace lumorph
