#include "core/geometry/surface_shading.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <map>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/geometry/coarse_surface.h"
#include "core/geometry/disjoint_sets.h"

namespace lumorph {
namespace {

constexpr std::uint32_t kNoVertex = UINT32_MAX;
constexpr std::size_t kCoarseTriangles = 9000;
// Each part is at least a box. Where there are more, as in a soup of triangles, they are no parts that one sees.
constexpr std::size_t kMostParts = kCoarseTriangles / 9;

// A corner of a face: the vertex of the mesh and the normal it shows.
struct Corner {
    std::uint32_t source, normal, corner;
    auto operator<=>(const Corner&) const = default; // NOLINT(modernize-use-nullptr): misread by clang-tidy 14
};

struct HalfEdge {
    std::uint32_t from, to; // places
    std::uint32_t corner;   // at `from`; the one at `to` is the face's next
    [[nodiscard]] auto places() const { return std::minmax(from, to); }
};

std::uint32_t nextCorner(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

void requireVertices(const TriangleMesh& mesh) {
    const std::size_t count = mesh.positions.size();
    for (const glm::uvec3& t : mesh.triangles)
        if (t.x >= count || t.y >= count || t.z >= count)
            throw InvalidInput("mesh", "a triangle names a vertex beyond the " + std::to_string(count) + " there are",
                               "check the mesh");
}

// For every vertex the first vertex at the same place.
std::vector<std::uint32_t> firstAtPlace(const std::vector<glm::vec3>& positions) {
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto key = [&](std::uint32_t i) { return std::tuple(positions[i].x, positions[i].y, positions[i].z); };
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return key(a) < key(b); });
    std::vector<std::uint32_t> places(positions.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        places[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? places[order[i - 1]] : order[i];
    return places;
}

// All half-edges, those between the same two places side by side.
std::vector<HalfEdge> halfEdgesOf(const TriangleMesh& mesh, const std::vector<std::uint32_t>& places) {
    std::vector<HalfEdge> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
        for (std::uint32_t k = 0; k < 3; ++k) {
            const auto at = [&](std::uint32_t i) { return places[mesh.triangles[f][static_cast<int>(i % 3)]]; };
            edges.push_back({at(k), at(k + 1), 3 * f + k});
        }
    std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::tuple(a.places(), a.corner) < std::tuple(b.places(), b.corner);
    });
    return edges;
}

// Calls visit(first, last) for each run of half-edges between the same two places.
template <class Visit> void forEachSharedEdge(const std::vector<HalfEdge>& edges, const Visit& visit) {
    for (auto first = edges.begin(); first != edges.end();) {
        const auto last =
            std::find_if(first, edges.end(), [&](const HalfEdge& e) { return e.places() != first->places(); });
        visit(first, last);
        first = last;
    }
}

std::vector<glm::vec3> faceNormals(const TriangleMesh& mesh) {
    std::vector<glm::vec3> normals;
    normals.reserve(mesh.triangles.size());
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]);
        const glm::dvec3 area = glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
        const double size = glm::length(area);
        normals.emplace_back(size > 0.0 && std::isfinite(size) ? area / size : glm::dvec3(0.0));
    }
    return normals;
}

// Corners that share a normal: those at one place that are linked by smooth edges. A face without area has no side
// to be smooth with.
DisjointSets smoothCorners(const std::vector<HalfEdge>& edges, const std::vector<glm::vec3>& normals, Angle crease) {
    DisjointSets sets(3 * normals.size());
    const auto limit = static_cast<float>(std::cos(crease.inRadians()));
    forEachSharedEdge(edges, [&](auto first, auto last) {
        if (first->from == first->to) return;
        for (auto a = first; a != last; ++a)
            for (auto b = a + 1; b != last; ++b) {
                if (!(glm::dot(normals[a->corner / 3], normals[b->corner / 3]) > limit)) continue;
                const bool along = a->from == b->from;
                sets.join(a->corner, along ? b->corner : nextCorner(b->corner));
                sets.join(nextCorner(a->corner), along ? nextCorner(b->corner) : b->corner);
            }
    });
    return sets;
}

// For every vertex of the mesh a number of the part that it belongs to: those of one number in `given` that hang
// together by edges. An edge of four faces is where two bodies touch.
std::vector<std::uint32_t> partsOf(const TriangleMesh& mesh, const std::vector<HalfEdge>& edges,
                                   std::span<const std::uint32_t> given) {
    DisjointSets pieces(mesh.positions.size());
    for (const glm::uvec3& t : mesh.triangles) {
        pieces.join(t.x, t.y);
        pieces.join(t.y, t.z);
    }
    const auto at = [&](std::uint32_t corner) { return mesh.triangles[corner / 3][static_cast<int>(corner % 3)]; };
    forEachSharedEdge(edges, [&](auto first, auto last) {
        if (last - first == 2) pieces.join(at(first->corner), at((first + 1)->corner)); // their faces join the rest
    });
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> numbers;
    std::vector<std::uint32_t> parts(mesh.positions.size());
    for (std::uint32_t i = 0; i < parts.size(); ++i)
        parts[i] = numbers.try_emplace({pieces.find(i), given.empty() ? 0 : given[i]}, numbers.size()).first->second;
    if (numbers.size() > kMostParts) std::fill(parts.begin(), parts.end(), 0U);
    return parts;
}

bool closedOutwards(const TriangleMesh& mesh, const std::vector<HalfEdge>& edges) {
    bool closed = !edges.empty();
    forEachSharedEdge(edges, [&](auto first, auto last) {
        const auto along = std::count_if(first, last, [&](const HalfEdge& e) { return e.from == first->from; });
        closed = closed && (first->from == first->to || 2 * along == last - first);
    });
    return closed && signedVolume(mesh) > 0.0;
}

} // namespace

SurfaceShading::SurfaceShading(const TriangleMesh& mesh, Angle crease, std::span<const std::uint32_t> parts)
    : meshVertexCount_(mesh.positions.size()) {
    if (!parts.empty() && parts.size() != mesh.positions.size())
        throw InvalidInput("parts",
                           "there is not one for each of the " + std::to_string(mesh.positions.size()) + " vertices",
                           "give as many, or none");
    fine_.triangles.resize(mesh.triangles.size());
    requireVertices(mesh);
    const std::vector<HalfEdge> edges = halfEdgesOf(mesh, firstAtPlace(mesh.positions));
    closed_ = closedOutwards(mesh, edges);
    DisjointSets smooth = smoothCorners(edges, faceNormals(mesh), crease);

    // A drawn vertex is a vertex of the mesh with one of its normals.
    std::vector<Corner> corners(3 * mesh.triangles.size());
    for (std::uint32_t i = 0; i < corners.size(); ++i)
        corners[i] = {mesh.triangles[i / 3][static_cast<int>(i % 3)], smooth.find(i), i};
    std::sort(corners.begin(), corners.end());
    std::vector<std::uint32_t> leaderOf(corners.size(), kNoVertex);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const auto& [source, normal, corner] = corners[i];
        if (i == 0 || source != corners[i - 1].source || normal != corners[i - 1].normal) {
            const auto drawn = static_cast<std::uint32_t>(fine_.sources.size());
            if (leaderOf[normal] == kNoVertex) leaderOf[normal] = drawn;
            fine_.sources.push_back(source);
            fine_.leaders.push_back(leaderOf[normal]);
        }
        fine_.triangles[corner / 3][static_cast<int>(corner % 3)] =
            static_cast<std::uint32_t>(fine_.sources.size() - 1);
    }
    if (mesh.triangles.size() > kCoarseTriangles) addCoarseForm(mesh.positions, partsOf(mesh, edges, parts));
}

void SurfaceShading::addCoarseForm(std::span<const glm::vec3> positions, std::span<const std::uint32_t> parts) {
    std::vector<ShadedMesh::Vertex> vertices(fine_.sources.size());
    shade(positions, vertices);
    std::vector<std::uint32_t> partOfDrawn;
    partOfDrawn.reserve(vertices.size());
    for (const std::uint32_t source : fine_.sources) partOfDrawn.push_back(parts[source]);
    CoarseSurface coarse = coarseSurface(vertices, partOfDrawn, fine_.triangles, kCoarseTriangles);
    coarse_.triangles = std::move(coarse.triangles);
    for (const std::uint32_t vertex : coarse.vertices) coarse_.sources.push_back(fine_.sources[vertex]);
    coarse_.leaders.resize(coarse_.sources.size());
    std::iota(coarse_.leaders.begin(), coarse_.leaders.end(), 0U);
}

void SurfaceShading::shade(std::span<const glm::vec3> positions, std::span<ShadedMesh::Vertex> out,
                           Detail detail) const noexcept {
    const auto& [triangles, sources, leaders] = form(detail);
    for (std::size_t i = 0; i < sources.size(); ++i) out[i] = {positions[sources[i]], glm::vec3(0.0F)};
    for (const glm::uvec3& t : triangles) {
        const glm::vec3 a = out[t.x].position;
        const glm::vec3 area = glm::cross(out[t.y].position - a, out[t.z].position - a);
        out[leaders[t.x]].normal += area;
        out[leaders[t.y]].normal += area;
        out[leaders[t.z]].normal += area;
    }
    // A leader stands before those it leads.
    for (std::size_t i = 0; i < sources.size(); ++i) {
        if (leaders[i] != i) {
            out[i].normal = out[leaders[i]].normal;
            continue;
        }
        const float length = glm::length(out[i].normal);
        if (length > 0.0F) out[i].normal /= length;
    }
}

} // namespace lumorph
