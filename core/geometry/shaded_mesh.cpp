#include "core/geometry/shaded_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/error.h"

namespace lumorph {
namespace {

struct Face {
    glm::uvec3 corners; // into the mesh's positions
    glm::vec3 normal;
    glm::vec3 angles;
};

struct FaceCorner {
    std::uint32_t face;
    int index;
};

bool finite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

void requireFinite(const TriangleMesh& mesh) {
    const std::size_t count = mesh.positions.size();
    for (const glm::uvec3& t : mesh.triangles)
        if (t.x >= count || t.y >= count || t.z >= count)
            throw InvalidInput("mesh", "a triangle names a vertex beyond the " + std::to_string(count) + " there are",
                               "check the mesh");
    for (const glm::vec3& p : mesh.positions)
        if (!finite(p)) throw InvalidInput("mesh", "a coordinate is not a finite number", "check the mesh");
}

float angleAt(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 u = b - a;
    const glm::dvec3 v = c - a;
    return static_cast<float>(std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v)));
}

std::vector<Face> facesOf(const TriangleMesh& mesh) {
    std::vector<Face> faces;
    faces.reserve(mesh.triangles.size());
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]);
        const glm::dvec3 b(mesh.positions[t.y]);
        const glm::dvec3 c(mesh.positions[t.z]);
        const glm::dvec3 area = glm::cross(b - a, c - a);
        const double size = glm::length(area);
        if (!(size > 0.0)) continue;
        faces.push_back({t, glm::vec3(area / size), {angleAt(a, b, c), angleAt(b, c, a), angleAt(c, a, b)}});
    }
    return faces;
}

// For every vertex the first vertex at the same place.
std::vector<std::uint32_t> sharedPlaces(const std::vector<glm::vec3>& positions) {
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto key = [&](std::uint32_t i) {
        const glm::vec3& p = positions[i];
        return std::tuple(p.x, p.y, p.z);
    };
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return key(a) < key(b); });
    std::vector<std::uint32_t> places(positions.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        places[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? places[order[i - 1]] : order[i];
    return places;
}

} // namespace

ShadedMesh shade(const TriangleMesh& mesh, Angle crease) {
    requireFinite(mesh);
    const std::vector<Face> faces = facesOf(mesh);
    const std::vector<std::uint32_t> places = sharedPlaces(mesh.positions);

    // The corners around each place, as runs in one array.
    std::vector<std::uint32_t> begin(mesh.positions.size() + 1, 0);
    for (const Face& face : faces)
        for (int k = 0; k < 3; ++k) ++begin[places[face.corners[k]] + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<FaceCorner> corners(faces.size() * 3);
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    for (std::uint32_t f = 0; f < faces.size(); ++f)
        for (int k = 0; k < 3; ++k) corners[next[places[faces[f].corners[k]]]++] = {f, k};

    ShadedMesh shaded;
    shaded.triangles.resize(faces.size());
    const auto limit = static_cast<float>(std::cos(crease.inRadians()));
    for (std::size_t place = 0; place + 1 < begin.size(); ++place) {
        const std::size_t firstVertex = shaded.vertices.size();
        for (std::uint32_t i = begin[place]; i < begin[place + 1]; ++i) {
            const glm::vec3 own = faces[corners[i].face].normal;
            glm::vec3 sum(0.0F);
            for (std::uint32_t j = begin[place]; j < begin[place + 1]; ++j) {
                const Face& other = faces[corners[j].face];
                if (i == j || glm::dot(own, other.normal) > limit) sum += other.angles[corners[j].index] * other.normal;
            }
            // A wide crease may let opposite faces cancel.
            const float length = glm::length(sum);
            const ShadedMesh::Vertex vertex{mesh.positions[place], length > 1e-6F ? sum / length : own};
            const auto known = std::find(shaded.vertices.begin() + static_cast<std::ptrdiff_t>(firstVertex),
                                         shaded.vertices.end(), vertex);
            shaded.triangles[corners[i].face][corners[i].index] =
                static_cast<std::uint32_t>(known - shaded.vertices.begin());
            if (known == shaded.vertices.end()) shaded.vertices.push_back(vertex);
        }
    }
    return shaded;
}

} // namespace lumorph
