#include "core/geometry/mesh_topology.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/geometry/position_index.h"

namespace lumorph {
namespace {

void checkIndices(const TriangleMesh& mesh) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::uvec3& corners = mesh.triangles[t];
        if (std::max({corners.x, corners.y, corners.z}) >= mesh.positions.size())
            throw InvalidInput("mesh, triangle " + std::to_string(t), "refers to a vertex that is not there",
                               "read the mesh from its file again");
    }
}

bool isFinite(const glm::vec3& p) noexcept { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// Groups half-edges by the two ends that `ends` numbers, whatever their direction, and hands each
/// group to `visit`. Sorting within the bucket of the smaller end beats sorting all at once.
template <typename Ends, typename Visit>
void forEachEdge(std::span<const std::uint32_t> halfEdges, std::size_t endCount, Ends ends, Visit visit) {
    std::vector<std::size_t> first(endCount + 1, 0);
    for (const std::uint32_t h : halfEdges) ++first[std::min(ends(h).first, ends(h).second) + 1];
    for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
    std::vector<std::pair<std::uint32_t, std::uint32_t>> entries(halfEdges.size()); // larger end, half-edge
    std::vector<std::size_t> fill(first.begin(), first.end() - 1);
    for (const std::uint32_t h : halfEdges) {
        const auto [a, b] = ends(h);
        entries[fill[std::min(a, b)]++] = {std::max(a, b), h};
    }
    std::vector<std::uint32_t> group;
    for (std::size_t end = 0; end < endCount; ++end) {
        const auto bucket = std::span(entries).subspan(first[end], first[end + 1] - first[end]);
        std::ranges::sort(bucket);
        for (std::size_t i = 0; i < bucket.size();) {
            group.clear();
            const std::uint32_t other = bucket[i].first;
            for (; i < bucket.size() && bucket[i].first == other; ++i) group.push_back(bucket[i].second);
            visit(std::span<const std::uint32_t>(group));
        }
    }
}

} // namespace

std::uint32_t MeshTopology::startPlace(const TriangleMesh& mesh, std::uint32_t halfEdge) const noexcept {
    return places[vertexAt(mesh, halfEdge)];
}

std::uint32_t MeshTopology::endPlace(const TriangleMesh& mesh, std::uint32_t halfEdge) const noexcept {
    return places[vertexAt(mesh, nextInTriangle(halfEdge))];
}

MeshTopology meshTopology(const TriangleMesh& mesh) {
    checkIndices(mesh);
    MeshTopology topology;
    topology.places = placesOf(mesh.positions);
    topology.partner.assign(3 * mesh.triangles.size(), MeshTopology::kNone);
    topology.ignored.assign(mesh.triangles.size(), false);

    std::vector<std::uint32_t> open;
    open.reserve(3 * mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::uvec3& corners = mesh.triangles[t];
        const std::uint32_t a = topology.places[corners.x];
        const std::uint32_t b = topology.places[corners.y];
        const std::uint32_t c = topology.places[corners.z];
        topology.ignored[t] = a == b || b == c || c == a || !isFinite(mesh.positions[corners.x]) ||
                              !isFinite(mesh.positions[corners.y]) || !isFinite(mesh.positions[corners.z]);
        if (!topology.ignored[t])
            for (std::uint32_t k = 0; k < 3; ++k) open.push_back(3 * t + k);
    }

    const auto pair = [&](std::uint32_t a, std::uint32_t b) {
        topology.partner[a] = b;
        topology.partner[b] = a;
        if (topology.startPlace(mesh, a) == topology.startPlace(mesh, b)) ++topology.disagreements;
    };
    forEachEdge(
        open, mesh.positions.size(),
        [&](std::uint32_t h) { return std::pair(vertexAt(mesh, h), vertexAt(mesh, nextInTriangle(h))); },
        [&](std::span<const std::uint32_t> group) {
            if (group.size() == 2) pair(group[0], group[1]);
        });
    std::erase_if(open, [&](std::uint32_t h) { return topology.partner[h] != MeshTopology::kNone; });
    forEachEdge(
        open, mesh.positions.size(),
        [&](std::uint32_t h) { return std::pair(topology.startPlace(mesh, h), topology.endPlace(mesh, h)); },
        [&](std::span<const std::uint32_t> group) {
            if (group.size() == 1) topology.boundary.push_back(group[0]);
            if (group.size() == 2) pair(group[0], group[1]);
            if (group.size() > 2) topology.crowdedEdges.emplace_back(group.begin(), group.end());
        });
    return topology;
}

} // namespace lumorph
