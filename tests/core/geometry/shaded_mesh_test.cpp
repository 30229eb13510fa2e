#include "core/geometry/shaded_mesh.h"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/core/render/shapes.h"

namespace lumorph {
namespace {

TEST(ShadedMesh, ABoxKeepsItsSharpEdges) {
    const ShadedMesh shaded = shade(boxMesh(glm::vec3(0.0F), glm::vec3(1.0F, 2.0F, 3.0F)), Angle::degrees(35.0));
    EXPECT_EQ(shaded.vertices.size(), 24U); // eight corners, three faces each
    for (const ShadedMesh::Vertex& vertex : shaded.vertices) {
        const glm::vec3 n = glm::abs(vertex.normal);
        EXPECT_NEAR(std::max({n.x, n.y, n.z}), 1.0F, 1e-6F);
    }
}

TEST(ShadedMesh, ATorusIsSmoothAndItsNormalsAreTheTorus) {
    const float radius = 0.06F;
    const float tube = 0.02F;
    const TriangleMesh mesh = torusMesh(radius, tube, 96);
    const ShadedMesh shaded = shade(mesh, Angle::degrees(35.0));
    EXPECT_EQ(shaded.vertices.size(), mesh.positions.size());
    for (const ShadedMesh::Vertex& vertex : shaded.vertices) {
        const glm::vec3 ring = radius * glm::normalize(glm::vec3(vertex.position.x, 0.0F, vertex.position.z));
        const glm::vec3 exact = glm::normalize(vertex.position - (ring + glm::vec3(0.0F, tube, 0.0F)));
        EXPECT_GT(glm::dot(vertex.normal, exact), 0.9995F);
    }
}

TEST(ShadedMesh, ACreaseOfZeroMakesEveryFaceFlat) {
    const TriangleMesh mesh = torusMesh(0.06F, 0.02F, 24);
    const ShadedMesh shaded = shade(mesh, Angle::degrees(0.0));
    for (const glm::uvec3& t : shaded.triangles) {
        EXPECT_LT(glm::distance(shaded.vertices[t.x].normal, shaded.vertices[t.y].normal), 1e-5F);
        EXPECT_LT(glm::distance(shaded.vertices[t.x].normal, shaded.vertices[t.z].normal), 1e-5F);
    }
}

TEST(ShadedMesh, VerticesAtOnePlaceCountAsOne) {
    TriangleMesh soup; // every triangle with vertices of its own, as in an .stl file
    const TriangleMesh mesh = torusMesh(0.06F, 0.02F, 48);
    for (const glm::uvec3& t : mesh.triangles) {
        const auto next = static_cast<unsigned>(soup.positions.size());
        soup.positions.insert(soup.positions.end(), {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]});
        soup.triangles.push_back({next, next + 1, next + 2});
    }
    EXPECT_EQ(shade(soup, Angle::degrees(35.0)).vertices.size(), mesh.positions.size());
}

TEST(ShadedMesh, LeavesOutTrianglesWithoutAreaAndRefusesNonsense) {
    TriangleMesh mesh = boxMesh(glm::vec3(0.0F), glm::vec3(1.0F));
    mesh.triangles.push_back({0, 0, 1});
    EXPECT_EQ(shade(mesh, Angle::degrees(35.0)).triangles.size(), 12U);
    mesh.triangles.back() = {0, 1, 8};
    EXPECT_THROW((void)shade(mesh, Angle::degrees(35.0)), InvalidInput);
    mesh.triangles.pop_back();
    mesh.positions[3].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW((void)shade(mesh, Angle::degrees(35.0)), InvalidInput);
}

} // namespace
} // namespace lumorph
