#include "core/render/eye/creases.h"

#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/core/render/shapes.h"

namespace lumorph {
namespace {

/// A strip along x, 0.2 m long, in `columns` columns and two rows, bent by `degrees` over an arc of `arc` metres in its
/// middle.
TriangleMesh strip(int columns, double degrees, double arc) {
    TriangleMesh mesh;
    const double turn = degrees * std::numbers::pi / 180.0;
    glm::dvec2 at(-0.1, 0.0);
    double heading = 0.0;
    const double step = 0.2 / columns;
    for (int i = 0; i <= columns; ++i) {
        for (const double z : {-0.03, 0.0, 0.03}) mesh.positions.push_back(glm::vec3(at.x, at.y, z));
        const double way = (i + 0.5) * step - 0.1; // of the middle of the next piece
        heading = turn * (arc > 0.0 ? glm::clamp(way / arc + 0.5, 0.0, 1.0) : (way > 0.0 ? 1.0 : 0.0));
        at += step * glm::dvec2(std::cos(heading), std::sin(heading));
    }
    for (int i = 0; i < columns; ++i)
        for (int row = 0; row < 2; ++row) {
            const auto a = static_cast<unsigned>(3 * i + row);
            mesh.triangles.push_back({a, a + 1, a + 4});
            mesh.triangles.push_back({a, a + 4, a + 3});
        }
    return mesh;
}

TEST(Creases, ABoxHasItsTwelveEdges) {
    const TriangleMesh box = boxMesh({-0.05F, 0.0F, -0.04F}, {0.05F, 0.03F, 0.04F});
    const auto creases = CreaseFinder(box).find(box.positions, Angle::degrees(8.0));
    EXPECT_EQ(creases.size(), 12U);
    for (const Crease& crease : creases) EXPECT_NEAR(crease.angle.inDegrees(), 90.0, 0.01);
}

TEST(Creases, OfAStripAreWhereItFolds) {
    struct Row {
        double degrees, arc, threshold;
        bool found;
    };
    // clang-format off
    const Row rows[] = {{  5.0, 0.000,  8.0, false}, // too flat
                        {  5.0, 0.000,  3.0, true},
                        { 20.0, 0.000,  8.0, true},
                        { 60.0, 0.000,  8.0, true},
                        {-60.0, 0.000,  8.0, true},  // downwards
                        {  5.0, 0.020,  8.0, false}, // over ten edges
                        { 20.0, 0.020,  8.0, true},
                        { 60.0, 0.020,  8.0, true},
                        { 60.0, 0.180, 20.0, false}, // a wide curve is no fold
                        {  0.0, 0.000,  1.0, false}};
    // clang-format on
    for (const Row& row : rows) {
        const TriangleMesh flat = strip(100, 0.0, 0.0);
        const TriangleMesh bent = strip(100, row.degrees, row.arc);
        const auto creases = CreaseFinder(flat).find(bent.positions, Angle::degrees(row.threshold));
        SCOPED_TRACE(std::to_string(row.degrees) + " over " + std::to_string(row.arc));
        ASSERT_EQ(!creases.empty(), row.found);
        double length = 0.0;
        for (const Crease& crease : creases) {
            // Upwards from above is a valley.
            EXPECT_NEAR(crease.angle.inDegrees(), -row.degrees, 0.02 * std::abs(row.degrees) + 0.01);
            for (const std::uint32_t vertex : crease.vertices) EXPECT_NEAR(flat.positions[vertex].x, 0.0, 0.0021);
            length += glm::distance(crease.ends[0], crease.ends[1]);
        }
        if (row.found) {
            EXPECT_NEAR(length, 0.06, 1e-4); // one line across, once
        }
    }
}

TEST(Creases, StripsAreAsWideAsAskedAndFadeIn) {
    const TriangleMesh bent = strip(100, 60.0, 0.0);
    const auto creases = CreaseFinder(bent).find(bent.positions, Angle::degrees(8.0));
    for (const auto& [threshold, strength] : {std::pair(59.9, 0.0F), std::pair(50.0, 0.4F), std::pair(8.0, 1.0F)}) {
        const CreaseStrips strips = creaseStrips(creases, 0.004, Angle::degrees(threshold));
        ASSERT_EQ(strips.triangles.size(), 4 * creases.size());
        for (std::size_t i = 0; i < strips.positions.size(); ++i) {
            const glm::vec3& nearest = bent.positions[strips.vertices[i]];
            EXPECT_NEAR(glm::distance(strips.positions[i], nearest), 0.002 * strips.across[i].x, 1e-6);
            EXPECT_NEAR(strips.across[i].y, strength, 0.01F);
        }
    }
}

TEST(Creases, SoftNormalsTurnGradually) {
    const TriangleMesh bent = strip(100, 60.0, 0.0);
    const auto normals = CreaseFinder(bent).softNormals(bent.positions, 0.015);
    float steepest = 0.0F;
    for (std::size_t column = 0; column + 1 < 101; ++column)
        steepest =
            std::max(steepest, std::acos(std::min(glm::dot(normals[3 * column], normals[3 * column + 3]), 1.0F)));
    EXPECT_LT(steepest, 0.21F); // radians, of the 1.05 at once before
    EXPECT_GT(glm::dot(normals.front(), {0.0F, 1.0F, 0.0F}), 0.999F);
}

TEST(Creases, RefuseAnIndexBeyondThePositions) {
    TriangleMesh mesh = strip(2, 0.0, 0.0);
    mesh.triangles.push_back({0, 1, 99});
    EXPECT_THROW((CreaseFinder(mesh)), InvalidInput);
}

} // namespace
} // namespace lumorph
