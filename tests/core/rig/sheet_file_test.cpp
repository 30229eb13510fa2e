#include <functional>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/model.h"
#include "core/rig/rig_file.h"
#include "core/rig/shape_report.h"
#include "tests/core/rig/small_sheet.h"
#include "tests/support/lifted_sheet.h"

namespace lumorph {
namespace {

using nlohmann::json;

TEST(SheetFile, GivesBackEveryBit) {
    for (RigParts parts : {test::smallSheetParts(), test::liftedSheetParts()}) {
        parts.actuators[1].maxVelocity = 0.77;
        parts.sheet->followers.back().share = 0.3F; // of a vertex that follows nothing
        parts.sheet->modes.secondStates = 7;
        parts.sheet->modes.secondDistance = 0.0137F;
        const Rig rig(std::move(parts));
        const auto bytes = writeRigGlb(rig);
        const Rig read = readRigGlb(bytes, "sheet.glb");
        EXPECT_EQ(read.parts().sheet, rig.parts().sheet);
        EXPECT_EQ(read.parts(), rig.parts());
        EXPECT_EQ(writeRigGlb(read), bytes);
    }
}

// A modelling tool shows them as shape keys of the mesh.
TEST(SheetFile, ModesAreMorphTargetsOfTheMesh) {
    const RigParts parts = test::smallSheetParts();
    const Model model = readGlb(writeRigGlb(Rig(parts)), "sheet.glb");
    ASSERT_EQ(model.meshes.size(), 1U);
    EXPECT_EQ(model.meshes[0].targetNames, (std::vector<std::string>{"sheet mode 1", "sheet mode 2"}));
    for (std::size_t v = 0; v < parts.restMesh.positions.size(); ++v)
        for (std::size_t k = 0; k < 2; ++k) {
            const std::uint32_t row = parts.sheet->followers[v].row;
            EXPECT_EQ(model.meshes[0].primitives[0].morphTargets[k][v],
                      row == SheetMotion::kNoRow ? glm::vec3(0.0F) : parts.sheet->modes.modes[2 * row + k]);
        }
}

// As modelling tools export: each triangle's corners of their own, the place of the mesh in its node.
TEST(SheetFile, SplitCornersOnAPlacedNodeBecomeOneVertexAgain) {
    const RigParts parts = test::smallSheetParts();
    Model model = readGlb(writeRigGlb(Rig(parts)), "sheet.glb");
    model.extras["lumorph"].erase("uniqueVertices");
    const Model::Primitive whole = model.meshes[0].primitives[0];
    Model::Primitive& split = model.meshes[0].primitives[0];
    split.positions.clear(), split.triangles.clear();
    for (auto& target : split.morphTargets) target.clear();
    for (auto& [name, attribute] : split.custom) attribute.values.clear();
    for (const glm::uvec3& t : whole.triangles) {
        const auto first = static_cast<std::uint32_t>(split.positions.size());
        split.triangles.emplace_back(first, first + 1, first + 2);
        for (int corner = 0; corner < 3; ++corner) {
            split.positions.push_back(whole.positions[t[corner]]);
            for (std::size_t k = 0; k < 2; ++k) split.morphTargets[k].push_back(whole.morphTargets[k][t[corner]]);
            for (auto& [name, attribute] : split.custom)
                attribute.values.push_back(whole.custom.at(name).values[t[corner]]);
        }
    }
    model.nodes[0].translation = {0.5F, 0.0F, 0.0F};
    const Rig read = readRigGlb(writeGlb(model), "exported.glb");
    EXPECT_EQ(read.restMesh().positions.size(), parts.restMesh.positions.size());
    EXPECT_EQ(read.parts().sheet->modes, parts.sheet->modes) << "moving the node turns no displacement";
}

TEST(SheetFile, ReportNamesTheLevers) {
    const ShapeReport report = shapeReport(Rig(test::smallSheetParts()), 3, 1);
    EXPECT_EQ(report.actuators[0].deformer, "lever");
    EXPECT_EQ(report.actuators[0].unit, "rad");
    EXPECT_NEAR(report.actuators[0].rangeMax, Angle::degrees(55.0).inRadians(), 1e-12);
    EXPECT_GT(report.actuators[0].amplitude, 0.01);
    EXPECT_EQ(report.actuators[0].vertices, 4U);
}

struct BadFile {
    const char* name;
    const char* why; ///< part of the message
    std::function<void(Model&)> spoil;
};

json& sheetOf(Model& model) { return model.meshes[0].extras["lumorphSheet"]; }
std::vector<float>& attributeOf(Model& model, const char* name) {
    return model.meshes[0].primitives[0].custom.at(name).values;
}
/// A vertex of the first row.
std::size_t firstFollower(Model& model) {
    const auto& rows = attributeOf(model, "_SHEET_ROW");
    return static_cast<std::size_t>(std::ranges::find(rows, 0.0F) - rows.begin());
}

class SheetFileRefused : public testing::TestWithParam<BadFile> {};

TEST_P(SheetFileRefused, NamesFileAndRemedy) {
    Model model = readGlb(writeRigGlb(Rig(test::smallSheetParts())), "sheet.glb");
    ASSERT_NO_THROW((void)readRigGlb(writeGlb(model), "sheet.glb"));
    GetParam().spoil(model);
    try {
        (void)readRigGlb(writeGlb(model), "sheet.glb");
        FAIL() << "accepted";
    } catch (const DataError& error) {
        EXPECT_EQ(error.subject().find("sheet.glb"), 0U) << error.what();
        EXPECT_NE(error.why().find(GetParam().why), std::string::npos) << error.what();
        EXPECT_FALSE(error.remedy().empty());
    }
}

INSTANTIATE_TEST_SUITE_P(
    SheetFile, SheetFileRefused,
    testing::Values(
        BadFile{"NotAnObject", "not an object", [](Model& m) { sheetOf(m) = 7; }},
        BadFile{"NoSheet", "no sheet", [](Model& m) { m.meshes[0].extras.erase("lumorphSheet"); }},
        BadFile{"NoModes", "from 1 to 64", [](Model& m) { sheetOf(m).erase("modes"); }},
        BadFile{"NegativeModes", "from 1 to 64", [](Model& m) { sheetOf(m)["modes"] = -2; }},
        BadFile{"ManyModes", "from 1 to 64", [](Model& m) { sheetOf(m)["modes"] = 4'000'000'000U; }},
        BadFile{"StrokesText", "not a list", [](Model& m) { sheetOf(m)["strokes"] = "0, 1"; }},
        BadFile{"ManyStrokes", "more than 40", [](Model& m) { sheetOf(m)["strokes"] = std::vector<int>(41, 0); }},
        BadFile{"StrokesOfNoAxis", "from 0 to 1",
                [](Model& m) {
                    sheetOf(m)["strokes"] = {0.5, 1.0};
                }},
        BadFile{"NoCoefficients", "not a list", [](Model& m) { sheetOf(m).erase("coefficients"); }},
        BadFile{"FewCoefficients", "one coefficient", [](Model& m) { sheetOf(m)["coefficients"].erase(3); }},
        BadFile{"ManyCoefficients", "more than 65536",
                [](Model& m) { sheetOf(m)["coefficients"] = std::vector<int>(65'537, 0); }},
        BadFile{"CoefficientText", "not a finite number", [](Model& m) { sheetOf(m)["coefficients"][4] = "x"; }},
        BadFile{"CoefficientHuge", "not a finite number", [](Model& m) { sheetOf(m)["coefficients"][4] = 1e300; }},
        BadFile{"NoTarget", "no morph target \"sheet mode 2\"", [](Model& m) { m.meshes[0].targetNames[1] = "Key 2"; }},
        BadFile{"NoRows", "one displacement", [](Model& m) { m.meshes[0].primitives[0].custom.erase("_SHEET_ROW"); }},
        BadFile{"RowHalf", "does not exist", [](Model& m) { attributeOf(m, "_SHEET_ROW")[firstFollower(m)] = 0.5F; }},
        BadFile{"RowNegative", "does not exist",
                [](Model& m) { attributeOf(m, "_SHEET_ROW")[firstFollower(m)] = -3.0F; }},
        BadFile{"RowFar", "does not exist", [](Model& m) { attributeOf(m, "_SHEET_ROW")[firstFollower(m)] = 3e9F; }},
        BadFile{"RowMissing", "no vertex follows row 0",
                [](Model& m) { attributeOf(m, "_SHEET_ROW")[firstFollower(m)] = -1.0F; }},
        BadFile{"RowTwice", "differ in their modes",
                [](Model& m) { attributeOf(m, "_SHEET_ROW")[firstFollower(m)] = 1.0F; }},
        BadFile{"ShareZero", "within 0 and 1",
                [](Model& m) { attributeOf(m, "_SHEET_SHARE")[firstFollower(m)] = 0.0F; }},
        BadFile{"RowOfFour", "one number a vertex",
                [](Model& m) {
                    auto& rows = m.meshes[0].primitives[0].custom.at("_SHEET_ROW");
                    rows = {2, std::vector<float>(2 * rows.values.size(), 0.0F)};
                }},
        BadFile{"NoAxis", "no such axis", [](Model& m) { m.meshes[0].extras["lumorph"][0].erase("gridAxis"); }},
        BadFile{"NoLever", "no lever drives axis", [](Model& m) { m.meshes[0].extras["lumorph"].erase(1); }},
        BadFile{"LeverRange", "\"range\" is missing",
                [](Model& m) { m.meshes[0].extras["lumorph"][0].erase("range"); }},
        BadFile{"SecondSheet", "second mesh", [](Model& m) { m.meshes.push_back(m.meshes[0]); }}),
    [](const auto& kind) { return std::string(kind.param.name); });

} // namespace
} // namespace lumorph
