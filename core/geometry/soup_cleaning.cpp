#include "core/geometry/soup_cleaning.h"

#include <algorithm>
#include <array>
#include <unordered_map>

#include <glm/geometric.hpp>

#include "core/geometry/disjoint_sets.h"
#include "core/geometry/mesh_topology.h"
#include "core/geometry/position_index.h"
#include "core/geometry/triangle_area.h"

namespace lumorph {
namespace {

std::size_t erase(TriangleMesh& mesh, const std::vector<bool>& gone) {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        if (!gone[t]) mesh.triangles[kept++] = mesh.triangles[t];
    const std::size_t dropped = mesh.triangles.size() - kept;
    mesh.triangles.resize(kept);
    return dropped;
}

/// Cuts the triangle of half-edge `over` at `corner`, a vertex on that edge. Gives the second half.
glm::uvec3 splitAt(TriangleMesh& mesh, std::uint32_t over, std::uint32_t corner) {
    glm::uvec3& triangle = mesh.triangles[over / 3];
    const auto start = static_cast<int>(over % 3);
    const int end = (start + 1) % 3;
    glm::uvec3 other = triangle;
    other[start] = corner;
    triangle[end] = corner;
    return other;
}

/// The half-edge of a flat triangle that holds its middle corner, the one across from it.
std::uint32_t longEdge(const TriangleMesh& mesh, std::uint32_t triangle) noexcept {
    std::uint32_t best = 3 * triangle;
    double longest = -1.0;
    for (std::uint32_t h = 3 * triangle; h < 3 * triangle + 3; ++h) {
        const double length = glm::distance(glm::dvec3(mesh.positions[vertexAt(mesh, h)]),
                                            glm::dvec3(mesh.positions[vertexAt(mesh, nextInTriangle(h))]));
        if (length > longest) {
            longest = length;
            best = h;
        }
    }
    return best;
}

using Places = std::array<std::uint32_t, 3>;

struct PlacesHash {
    std::size_t operator()(const Places& p) const noexcept {
        std::uint64_t hash = p[0];
        hash = (hash * 0x9E3779B97F4A7C15ULL) ^ p[1];
        hash = (hash * 0x9E3779B97F4A7C15ULL) ^ p[2];
        return static_cast<std::size_t>((hash * 0x9E3779B97F4A7C15ULL) >> 16U);
    }
};

/// Triangles on the same three places, by the way they face.
struct Stack {
    std::vector<std::uint32_t> front;
    std::vector<std::uint32_t> back;
};

/// Triangles at an edge once plain repeats are gone.
struct EdgeUse {
    std::uint32_t single = 0;         ///< that stand alone on their three places
    std::vector<std::uint32_t> pairs; ///< that stand back to back, by the number of the pair
};

std::uint64_t edgeKey(std::uint32_t a, std::uint32_t b) noexcept {
    return (std::uint64_t{std::min(a, b)} << 32U) | std::max(a, b);
}

std::array<std::uint64_t, 3> edgeKeys(const Places& p) noexcept {
    return {edgeKey(p[0], p[1]), edgeKey(p[1], p[2]), edgeKey(p[2], p[0])};
}

/// For each pair of triangles back to back whether it belongs to a wall between solids: a patch of
/// such pairs all around which the surface closes without them.
std::vector<bool> innerWalls(const std::vector<Places>& pairs,
                             const std::unordered_map<std::uint64_t, EdgeUse>& edges) {
    DisjointSets patches(pairs.size());
    for (const auto& [key, use] : edges)
        for (const std::uint32_t pair : use.pairs)
            if (use.single == 0) patches.join(pair, use.pairs.front());
    std::vector<bool> sheet(pairs.size(), false);
    for (std::uint32_t i = 0; i < pairs.size(); ++i)
        for (const std::uint64_t key : edgeKeys(pairs[i])) {
            const EdgeUse& use = edges.at(key);
            if (use.single == 1 || (use.single == 0 && use.pairs.size() != 2)) sheet[patches.find(i)] = true;
        }
    std::vector<bool> walls(pairs.size());
    for (std::uint32_t i = 0; i < pairs.size(); ++i) walls[i] = !sheet[patches.find(i)];
    return walls;
}

} // namespace

std::size_t dropCollapsedTriangles(TriangleMesh& mesh) { return erase(mesh, meshTopology(mesh).ignored); }

std::size_t dissolveFlatTriangles(TriangleMesh& mesh) {
    std::size_t dissolved = 0;
    // Flat triangles may lie next to each other: each round takes those next to a sound one. The
    // limit is for nests that never come apart.
    for (int round = 0; round < 64; ++round) {
        const MeshTopology topology = meshTopology(mesh);
        std::vector<bool> gone(mesh.triangles.size(), false);
        std::vector<bool> touched(mesh.triangles.size(), false);
        std::vector<glm::uvec3> added;
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            if (topology.ignored[t] || touched[t] || !isFlat(mesh, t)) continue;
            const std::uint32_t edge = longEdge(mesh, t);
            const std::uint32_t over = topology.partner[edge];
            if (over != MeshTopology::kNone) {
                if (touched[over / 3]) continue;
                touched[over / 3] = true;
                added.push_back(splitAt(mesh, over, vertexAt(mesh, nextInTriangle(nextInTriangle(edge)))));
            }
            gone[t] = touched[t] = true;
        }
        const std::size_t dropped = erase(mesh, gone);
        if (dropped == 0) break;
        dissolved += dropped;
        mesh.triangles.insert(mesh.triangles.end(), added.begin(), added.end());
        dropCollapsedTriangles(mesh);
    }
    return dissolved;
}

std::size_t dropRepeatedTriangles(TriangleMesh& mesh) {
    const std::vector<std::uint32_t> places = placesOf(mesh.positions);
    std::unordered_map<Places, Stack, PlacesHash> stacks;
    stacks.reserve(mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::uvec3& corners = mesh.triangles[t];
        Places key{places[corners.x], places[corners.y], places[corners.z]};
        std::rotate(key.begin(), std::ranges::min_element(key), key.end());
        const bool front = key[1] < key[2];
        std::ranges::sort(key);
        Stack& stack = stacks[key];
        (front ? stack.front : stack.back).push_back(t);
    }

    std::vector<bool> gone(mesh.triangles.size(), false);
    std::vector<Places> pairs;
    std::unordered_map<std::uint64_t, EdgeUse> edges;
    for (const auto& [key, stack] : stacks) {
        for (const std::vector<std::uint32_t>* side : {&stack.front, &stack.back})
            for (std::size_t i = 1; i < side->size(); ++i) gone[(*side)[i]] = true;
        const bool pair = !stack.front.empty() && !stack.back.empty();
        for (const std::uint64_t edge : edgeKeys(key)) {
            if (pair)
                edges[edge].pairs.push_back(static_cast<std::uint32_t>(pairs.size()));
            else
                ++edges[edge].single;
        }
        if (pair) pairs.push_back(key);
    }
    const std::vector<bool> walls = innerWalls(pairs, edges);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const Stack& stack = stacks.at(pairs[i]);
        gone[stack.back.front()] = true;
        if (walls[i]) gone[stack.front.front()] = true;
    }
    if (std::ranges::find(gone, false) == gone.end()) return 0;
    return erase(mesh, gone);
}

} // namespace lumorph
