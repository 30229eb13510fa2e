#include "core/geometry/surface_shading.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/core/render/shapes.h"

namespace lumorph {
namespace {

const Angle kCrease = Angle::degrees(35.0);

std::vector<ShadedMesh::Vertex> shaded(const SurfaceShading& shading, const std::vector<glm::vec3>& positions) {
    std::vector<ShadedMesh::Vertex> out(shading.sources().size());
    shading.shade(positions, out);
    return out;
}

TEST(SurfaceShading, AgreesWithTheStillShadingOfTheSameMesh) {
    const TriangleMesh torus = torusMesh(0.06F, 0.02F, 96);
    const SurfaceShading shading(torus, kCrease);
    EXPECT_EQ(shading.sources().size(), torus.positions.size());
    EXPECT_TRUE(shading.closed());
    for (const ShadedMesh::Vertex& vertex : shaded(shading, torus.positions)) {
        const glm::vec3 ring = 0.06F * glm::normalize(glm::vec3(vertex.position.x, 0.0F, vertex.position.z));
        const glm::vec3 exact = glm::normalize(vertex.position - (ring + glm::vec3(0.0F, 0.02F, 0.0F)));
        EXPECT_GT(glm::dot(vertex.normal, exact), 0.999F);
    }
    const SurfaceShading box(boxMesh(glm::vec3(0.0F), glm::vec3(1.0F, 2.0F, 3.0F)), kCrease);
    EXPECT_EQ(box.sources().size(), 24U);
}

TEST(SurfaceShading, ABoxThatTurnsKeepsFlatFacesWithTurnedNormals) {
    const TriangleMesh box = boxMesh(glm::vec3(-1.0F), glm::vec3(1.0F));
    const SurfaceShading shading(box, kCrease);
    std::vector<glm::vec3> turned = box.positions;
    for (glm::vec3& p : turned) p = {0.6F * p.x - 0.8F * p.y, 0.8F * p.x + 0.6F * p.y, p.z};
    const auto vertices = shaded(shading, turned);
    for (const glm::uvec3& t : shading.triangles()) {
        const glm::vec3 a = vertices[t.x].position;
        const glm::vec3 flat = glm::normalize(glm::cross(vertices[t.y].position - a, vertices[t.z].position - a));
        for (int k = 0; k < 3; ++k) EXPECT_GT(glm::dot(vertices[t[k]].normal, flat), 0.9999F);
    }
}

TEST(SurfaceShading, PositionsAreThoseOfTheSources) {
    const TriangleMesh mesh = reliefMesh({0.1F, 0.1F}, 12, [](float x, float z) { return 0.02F + x * z; });
    const SurfaceShading shading(mesh, kCrease);
    ASSERT_EQ(shading.triangles().size(), mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (int k = 0; k < 3; ++k) EXPECT_EQ(shading.sources()[shading.triangles()[i][k]], mesh.triangles[i][k]);
}

TEST(SurfaceShading, ASlitMayOpen) {
    // Two squares that touch without sharing vertices.
    TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}},
                      {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}};
    const SurfaceShading shading(mesh, kCrease);
    EXPECT_FALSE(shading.closed());
    for (std::size_t i = 4; i < 8; ++i) mesh.positions[i].x += 0.5F;
    const auto vertices = shaded(shading, mesh.positions);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        EXPECT_EQ(vertices[i].position, mesh.positions[shading.sources()[i]]);
        EXPECT_NEAR(vertices[i].normal.z, 1.0F, 1e-5F);
    }
}

constexpr auto kCoarse = SurfaceShading::Detail::coarse;

/// `count` by `count` pins, 4 mm wide and 0.3 mm apart, each of `slices` rings, side by side in one mesh.
TriangleMesh pinField(int count, std::uint32_t slices) {
    TriangleMesh mesh;
    for (int pin = 0; pin < count * count; ++pin) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (std::uint32_t ring = 0; ring <= slices; ++ring)
            for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)})
                mesh.positions.emplace_back(0.0043F * static_cast<float>(pin % count) + 0.004F * corner.x,
                                            0.01F * static_cast<float>(ring),
                                            0.0043F * static_cast<float>(pin / count) + 0.004F * corner.y);
        for (std::uint32_t ring = 0; ring < slices; ++ring)
            for (std::uint32_t side = 0; side < 4; ++side) {
                const glm::uvec2 low = first + 4 * ring + glm::uvec2(side, (side + 1) % 4);
                mesh.triangles.emplace_back(low.x, low.x + 4, low.y);
                mesh.triangles.emplace_back(low.y, low.x + 4, low.y + 4);
            }
        for (const glm::uvec3 t : {glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)}) {
            mesh.triangles.push_back(first + t);
            mesh.triangles.push_back(first + 4 * slices + glm::uvec3(t.x, t.z, t.y));
        }
    }
    return mesh;
}

// Pins that rise one by one must not be seen as a wall: no triangle may reach from one to its neighbour.
TEST(SurfaceShading, TheCoarseFormKeepsPinsApart) {
    const TriangleMesh mesh = pinField(14, 10); // 16,464 triangles
    const SurfaceShading shading(mesh, kCrease);
    ASSERT_TRUE(shading.hasCoarse());
    const auto pinOf = [&](std::uint32_t drawn) {
        const glm::vec3 at = mesh.positions[shading.sources(kCoarse)[drawn]];
        return std::pair(std::floor((at.x + 0.0001F) / 0.0043F), std::floor((at.z + 0.0001F) / 0.0043F));
    };
    std::set<std::pair<float, float>> seen;
    for (const glm::uvec3& t : shading.triangles(kCoarse)) {
        EXPECT_EQ(pinOf(t.x), pinOf(t.y));
        EXPECT_EQ(pinOf(t.x), pinOf(t.z));
        seen.insert(pinOf(t.x));
    }
    EXPECT_EQ(seen.size(), 196U) << "pins have gone";
    EXPECT_THROW(SurfaceShading(mesh, kCrease, std::vector<std::uint32_t>(5)), InvalidInput);
}

TEST(SurfaceShading, TheCoarseFormIsSmallAndNearTheSurface) {
    const TriangleMesh torus = torusMesh(0.06F, 0.02F, 264);
    const SurfaceShading shading(torus, kCrease);
    ASSERT_GT(torus.triangles.size(), 65'000U);
    EXPECT_LT(shading.triangles(kCoarse).size(), 20'000U);
    EXPECT_GT(shading.triangles(kCoarse).size(), 3'000U);
    double area = 0.0;
    double coarse = 0.0;
    const auto areaOf = [&](const glm::uvec3& t, SurfaceShading::Detail detail) {
        const glm::vec3 a = torus.positions[shading.sources(detail)[t.x]];
        return 0.5 * static_cast<double>(glm::length(glm::cross(torus.positions[shading.sources(detail)[t.y]] - a,
                                                                torus.positions[shading.sources(detail)[t.z]] - a)));
    };
    for (const glm::uvec3& t : shading.triangles()) area += areaOf(t, SurfaceShading::Detail::fine);
    for (const glm::uvec3& t : shading.triangles(kCoarse)) coarse += areaOf(t, kCoarse);
    EXPECT_NEAR(coarse / area, 1.0, 0.08);
    const SurfaceShading small(boxMesh(glm::vec3(0.0F), glm::vec3(1.0F)), kCrease);
    EXPECT_EQ(small.triangles(kCoarse).size(), 12U);
}

TEST(SurfaceShading, RefusesAnIndexBeyondThePositions) {
    TriangleMesh mesh = boxMesh(glm::vec3(0.0F), glm::vec3(1.0F));
    mesh.triangles.push_back({0, 1, 8});
    EXPECT_THROW(SurfaceShading(mesh, kCrease), InvalidInput);
}

} // namespace
} // namespace lumorph
