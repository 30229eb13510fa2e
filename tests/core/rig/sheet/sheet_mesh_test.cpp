#include "core/rig/sheet/sheet_mesh.h"

#include <algorithm>
#include <functional>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/core/rig/sheet/small_sheet.h"

namespace lumorph {
namespace {

double areaOf(const SheetMesh& mesh, const glm::uvec3& t) {
    const glm::dvec2 a = mesh.points[t.y] - mesh.points[t.x];
    const glm::dvec2 b = mesh.points[t.z] - mesh.points[t.x];
    return 0.5 * (a.y * b.x - a.x * b.y); // positive where the normal is +y
}

TEST(SheetMesh, CoversTheOutlineOnce) {
    const SheetMesh mesh = meshSheet(smallSheet(), 0.007);
    double area = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        EXPECT_GT(areaOf(mesh, t), 0.1 * 0.007 * 0.007);
        area += areaOf(mesh, t);
    }
    EXPECT_NEAR(area, 0.12 * 0.08, 1e-12);
    for (const auto& [a, b] : mesh.edges) EXPECT_LT(glm::distance(mesh.points[a], mesh.points[b]), 2.0 * 0.007);
    EXPECT_EQ(mesh.points.size() + mesh.triangles.size(), mesh.edges.size() + 1); // Euler, a disc
}

TEST(SheetMesh, IsItsOwnMirrorImage) {
    const SheetMesh mesh = meshSheet(smallSheet(), 0.007);
    ASSERT_EQ(mesh.mirrors.size(), 2U);
    for (const MeshMirror& mirror : mesh.mirrors) {
        const int axis = mirror.axis;
        for (std::size_t k = 0; k < mesh.points.size(); ++k) {
            const glm::dvec2& image = mesh.points[mirror.nodes[k]];
            EXPECT_NEAR(image[axis], -mesh.points[k][axis], 1e-12);
            EXPECT_NEAR(image[1 - axis], mesh.points[k][1 - axis], 1e-12);
        }
        EXPECT_THAT(mirror.levers, axis == 0 ? testing::ElementsAre(1U, 0U) : testing::ElementsAre(0U, 1U));
        for (std::size_t k = 0; k < mesh.edges.size(); ++k) {
            const auto [low, high] = std::minmax({mirror.nodes[mesh.edges[k][0]], mirror.nodes[mesh.edges[k][1]]});
            EXPECT_EQ(mesh.edges[mirror.edges[k]], (std::array{low, high}));
        }
    }
}

TEST(SheetMesh, HasTheMirrorsOfItsDrawingOnly) {
    ElasticSheet sheet = smallSheet();
    sheet.levers.pop_back();
    const SheetMesh mesh = meshSheet(sheet, 0.01);
    ASSERT_EQ(mesh.mirrors.size(), 1U);
    EXPECT_EQ(mesh.mirrors[0].axis, 1);
    sheet.outline[0].x -= 0.003;
    EXPECT_TRUE(meshSheet(sheet, 0.01).mirrors.empty());
}

TEST(SheetMesh, FollowsTheLinesOfLeversAndThePad) {
    const SheetMesh mesh = meshSheet(smallSheet(), 0.007);
    ASSERT_EQ(mesh.lineNodes.size(), 2U);
    for (const auto& line : mesh.lineNodes) {
        EXPECT_GE(line.size(), 4U);
        for (const std::uint32_t k : line) {
            EXPECT_NEAR(std::abs(mesh.points[k].x), 0.052, 1e-9);
            EXPECT_LE(std::abs(mesh.points[k].y), 0.01 + 1e-9);
        }
    }
    const auto inPad = [&](const glm::dvec2& p) { return std::abs(p.x) < 0.015 + 1e-9 && std::abs(p.y) < 0.03 + 1e-9; };
    EXPECT_EQ(mesh.padNodes.size(), static_cast<std::size_t>(std::ranges::count_if(mesh.points, inPad)));
}

TEST(SheetMesh, DrawingsThatCannotWorkAreNamed) {
    struct Case {
        const char* message;
        std::function<void(ElasticSheet&)> change;
    };
    const std::vector<Case> cases{
        {"nobody holds it", [](ElasticSheet& sheet) { sheet.pad.clear(); }},
        {"outline has no area", [](ElasticSheet& sheet) { sheet.outline.clear(); }},
        {"line is shorter than 2 mm", [](ElasticSheet& sheet) { sheet.levers[0].to = sheet.levers[0].from; }},
        {"ends outside the sheet", [](ElasticSheet& sheet) { sheet.levers[0].to.x = -0.07; }},
        {"nearer than 1 mm to the rim", [](ElasticSheet& sheet) { sheet.levers[0].to.x = -0.0595; }},
        {"touches the clamped pad", [](ElasticSheet& sheet) { sheet.levers[0].to.x = 0.0; }},
        {"meets that of 'left'", [](ElasticSheet& sheet) { sheet.levers[1] = sheet.levers[0]; }},
        {"passes the vertical", [](ElasticSheet& sheet) { sheet.levers[1].end = Angle::degrees(120.0); }},
        {"none carries membrane forces", [](ElasticSheet& sheet) { sheet.layers[0].loose = true; }},
    };
    for (const Case& wrong : cases) {
        ElasticSheet sheet = smallSheet();
        wrong.change(sheet);
        try {
            (void)meshSheet(sheet, 0.01);
            ADD_FAILURE() << wrong.message;
        } catch (const InvalidInput& error) {
            EXPECT_THAT(error.what(), testing::HasSubstr(wrong.message));
        }
    }
    EXPECT_THROW((void)meshSheet(smallSheet(), 1e-6), InvalidInput);
}

} // namespace
} // namespace lumorph
