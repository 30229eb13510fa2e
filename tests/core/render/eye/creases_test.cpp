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

/// A sheet of 0.12 x 0.12 m in triangles of about 6 mm, none like another, bent by `degrees` over an arc of `arc`
/// metres along a line through its middle, which lies 25 degrees off the x axis. Second: the same, flat.
std::pair<TriangleMesh, TriangleMesh> obliqueBend(double degrees, double arc) {
    constexpr int kSide = 21;
    const double lineTurn = 25.0 * std::numbers::pi / 180.0, turn = degrees * std::numbers::pi / 180.0;
    const glm::dvec2 along(std::cos(lineTurn), std::sin(lineTurn)), across(-along.y, along.x);
    TriangleMesh bent, flat;
    for (int j = 0; j < kSide; ++j)
        for (int i = 0; i < kSide; ++i) {
            const glm::dvec2 shift(std::sin(12.9898 * i + 78.233 * j), std::sin(39.346 * i + 11.135 * j));
            const bool inside = i > 0 && j > 0 && i + 1 < kSide && j + 1 < kSide;
            const glm::dvec2 at = 0.006 * (glm::dvec2(i - 10, j - 10) + (inside ? 0.3 : 0.0) * shift);
            const double way = glm::dot(at, across), half = 0.5 * arc, radius = arc / turn;
            // Straight, then round, then straight.
            const double round = glm::clamp(way, -half, half) + half, angle = round / radius;
            const double before = std::min(way + half, 0.0), after = std::max(way - half, 0.0);
            const glm::dvec2 place(before + radius * std::sin(angle) + after * std::cos(turn),
                                   radius * (1.0 - std::cos(angle)) + after * std::sin(turn));
            const glm::dvec2 plane = glm::dot(at, along) * along + (place.x - half) * across;
            flat.positions.emplace_back(at.x, 0.0, -at.y);
            bent.positions.emplace_back(plane.x, place.y, -plane.y);
        }
    for (unsigned j = 0; j + 1 < kSide; ++j)
        for (unsigned i = 0; i + 1 < kSide; ++i) {
            const unsigned a = j * kSide + i, b = a + kSide;
            for (const glm::uvec3& t : (i + j) % 2 == 0 ? std::array<glm::uvec3, 2>{{{a, a + 1, b + 1}, {a, b + 1, b}}}
                                                        : std::array<glm::uvec3, 2>{{{a, a + 1, b}, {a + 1, b + 1, b}}})
                flat.triangles.push_back(t);
        }
    bent.triangles = flat.triangles;
    return {bent, flat};
}

TEST(Creases, RunStraightWhereASmoothSheetBendsMostAcrossItsTriangles) {
    const double line = 0.12 / std::cos(25.0 * std::numbers::pi / 180.0);
    for (const auto& [degrees, arc] : {std::pair(30.0, 0.02), {50.0, 0.02}, {-45.0, 0.02}}) {
        SCOPED_TRACE(degrees);
        const auto [bent, flat] = obliqueBend(degrees, arc);
        const auto creases = CreaseFinder(flat).find(bent.positions, Angle::degrees(8.0));
        double length = 0.0;
        for (const Crease& crease : creases) {
            for (const glm::vec3& end : crease.ends) {
                // Its height above the middle of the arc says on which side of the line it lies, and how far.
                const double radius = arc / (degrees * std::numbers::pi / 180.0);
                const double middle = radius * (1.0 - std::cos(0.5 * arc / radius));
                const double slope = std::sin(0.5 * arc / radius);
                EXPECT_NEAR(end.y, middle, 0.005 * std::abs(slope) + 0.0005); // less than a triangle
            }
            EXPECT_NEAR(std::abs(crease.angle.inDegrees()), std::abs(degrees),
                        0.4 * std::abs(degrees)); // less at the rim
            length += glm::distance(crease.ends[0], crease.ends[1]);
        }
        EXPECT_NEAR(length, line, 0.1 * line) << "one line, once, from rim to rim";
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
