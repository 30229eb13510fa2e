#include "core/geometry/mesh_file.h"

#include <cmath>
#include <fstream>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/mesh_check.h"
#include "core/geometry/mesh_parsers.h"
#include "tests/core/geometry/sample_mesh_files.h"
#include "tests/core/geometry/sample_meshes.h"
#include "tests/core/temporary_folder.h"

namespace lumorph {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

struct Readable {
    const char* name;
    const char* file;
    std::string content;
};

class ReadMeshFormats : public testing::TestWithParam<Readable> {};

TEST_P(ReadMeshFormats, GiveTheSameSolid) {
    const TemporaryFolder folder;
    std::ofstream(folder / GetParam().file, std::ios::binary) << GetParam().content;
    const TriangleMesh mesh = readMesh(folder / GetParam().file);
    EXPECT_EQ(mesh.positions.size(), 12U);
    EXPECT_EQ(mesh.triangles.size(), 20U); // two hexagons of 4, six quads of 2
    const MeshReport report = checkMesh(mesh);
    EXPECT_TRUE(report.solid()) << testing::PrintToString(report.findings());
    EXPECT_EQ(report.degenerateTriangles, 0U);
    EXPECT_EQ(report.components, 1U);
    EXPECT_NEAR(report.volume, 6.0, 1e-12);
    const Box box = boundingBox(mesh.positions);
    EXPECT_EQ(box.min, glm::vec3(0, 0, 0));
    EXPECT_EQ(box.max, glm::vec3(2, 2, 2));
}

using u8 = std::uint8_t;
using i32 = std::int32_t;
constexpr auto kLittle = std::endian::little;
constexpr auto kBig = std::endian::big;

// clang-format off
INSTANTIATE_TEST_SUITE_P(Prism, ReadMeshFormats, testing::Values(
    Readable{"Obj",              "a.obj", prismObj()},
    Readable{"ObjUpperCase",     "a.OBJ", prismObj()},
    Readable{"ObjCrLf",          "a.obj", replaced(prismObj(), "\n", "\r\n")},
    Readable{"ObjCr",            "a.obj", replaced(prismObj(), "\n", "\r")},
    Readable{"ObjByteOrderMark", "a.obj", "\xEF\xBB\xBF" + prismObj()},
    Readable{"ObjNegative",      "a.obj", prismObjNegative()},
    Readable{"ObjContinuedCrLf", "a.obj", replaced(prismObjNegative(), "\n", "\r\n")},
    Readable{"ObjFacesFirst",    "a.obj", prismObjFacesFirst()},
    Readable{"Off",              "a.off", prismOff("OFF\n", "", "")},
    Readable{"OffOneLine",       "a.off", prismOff("OFF", "", "")},
    Readable{"OffGlued",         "a.off", replaced(prismOff("OFF", "", ""), "OFF 12", "OFF12")},
    Readable{"OffNoEdgeCount",   "a.off", replaced(prismOff("OFF\n", "", ""), "12 8 0", "12 8")},
    Readable{"OffCrLf",          "a.off", replaced(prismOff("OFF\n", "", ""), "\n", "\r\n")},
    Readable{"OffColours",       "a.off", prismOff("COFF\n", " 255 0 0 255", " 0.5 0.5 0.5")},
    Readable{"OffNormals",       "a.off", prismOff("STCNOFF\n", " 0 0 1 255 0 0 255 0.5 0.5", "")},
    Readable{"PlyText",          "a.ply", prismPlyText()},
    Readable{"PlyTextCrLf",      "a.ply", replaced(prismPlyText(), "\n", "\r\n")},
    Readable{"PlyLittle",        "a.ply", prismPly<u8, i32>(kLittle, "uchar", "int")},
    Readable{"PlyLittleCrLf",    "a.ply", prismPly<u8, i32>(kLittle, "uchar", "int", "\r\n")},
    Readable{"PlyLittlePadded",  "a.ply", prismPly<u8, i32>(kLittle, "uchar", "int") + "\n"},
    Readable{"PlyBig",           "a.ply", prismPly<u8, i32>(kBig, "uint8", "int32")},
    Readable{"PlyBigShorts",     "a.ply", prismPly<i32, std::uint16_t>(kBig, "int", "ushort")},
    Readable{"PlyLittleChars",   "a.ply", prismPly<std::int16_t, std::int8_t>(kLittle, "short", "char")},
    Readable{"PlyLittleUints",   "a.ply", prismPly<std::uint32_t, std::uint32_t>(kLittle, "uint32", "uint")},
    Readable{"StlText",          "a.stl", prismStlText()},
    Readable{"StlTextUpperCase", "a.stl", replaced(replaced(prismStlText(), "facet", "FACET"), "solid", "SOLID")},
    Readable{"StlTextCrLf",      "a.stl", replaced(prismStlText(), "\n", "\r\n")},
    Readable{"StlBinary",        "a.stl", prismStl("made by a scanner")},
    Readable{"StlBinarySolid",   "a.stl", prismStl("solid prism")}),
    [](const auto& test) { return std::string(test.param.name); });
// clang-format on

TEST(ReadMeshObj, KeepsCoordinatesToTheBit) {
    const TriangleMesh mesh = parseObj(bytesOf("v 0.1 +1.5e-3 -2E2\nv 1e-60 1e-45 0\nv 16777217 .5 5.\nf 1 2 3"), "a");
    EXPECT_EQ(mesh.positions[0], glm::vec3(0.1F, 1.5e-3F, -200.0F));
    EXPECT_EQ(mesh.positions[1], glm::vec3(0.0F, 1e-45F, 0.0F)); // below the least float: zero
    EXPECT_EQ(mesh.positions[2], glm::vec3(16777216.0F, 0.5F, 5.0F));
}

TEST(ReadMeshObj, CutsDentedPolygonsWithoutFillingTheDents) {
    // A comb: fans from any one corner would cover the gaps.
    std::string text;
    std::string face = "f";
    int count = 0;
    const auto add = [&](double x, double y) {
        text += "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(0.3 * x) + "\n";
        face += " " + std::to_string(++count);
    };
    for (int tooth = 0; tooth < 20; ++tooth) {
        add(2 * tooth, 5);
        add(2 * tooth, 1);
        add(2 * tooth + 1, 1);
        add(2 * tooth + 1, 5);
    }
    add(40, 5);
    add(40, 0);
    add(-1, 0);
    add(-1, 5);
    const TriangleMesh mesh = parseObj(bytesOf(text + face), "comb");
    EXPECT_EQ(mesh.triangles.size(), static_cast<std::size_t>(count - 2));
    double area = 0.0; // seen from above
    double signedArea = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]);
        const glm::dvec3 n = glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
        area += 0.5 * std::abs(n.z);
        signedArea += 0.5 * n.z;
    }
    // A bar of 41 x 1 and 21 teeth of 1 x 4, clockwise from above.
    EXPECT_NEAR(area, 125.0, 1e-4);
    EXPECT_NEAR(signedArea, -125.0, 1e-4);
}

TEST(ReadMeshObj, MakesNoFlatTrianglesOfCornersOnAStraightSide) {
    const TriangleMesh mesh =
        parseObj(bytesOf("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nv 0 2 0\nf 1 2 3 4 5 6 7"), "a");
    EXPECT_EQ(mesh.triangles.size(), 5U);
    EXPECT_EQ(checkMesh(mesh).degenerateTriangles, 0U);
}

TEST(WriteMesh, ReadsBackBitEqual) {
    const TemporaryFolder folder;
    TriangleMesh mesh = torus(31, 17);
    mesh.positions[3] = {1.0F / 3.0F, 1e-45F, -3.4e38F};
    for (const char* const name : {"a.obj", "a.glb"}) {
        writeMesh(mesh, folder / name);
        const TriangleMesh back = readMesh(folder / name);
        EXPECT_EQ(back.positions, mesh.positions) << name;
        EXPECT_EQ(back.triangles, mesh.triangles) << name;
    }
    writeMesh(mesh, folder / "a.stl");
    const TriangleMesh back = readMesh(folder / "a.stl");
    EXPECT_EQ(back.positions.size(), mesh.positions.size());
    ASSERT_EQ(back.triangles.size(), mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(back.positions[back.triangles[t][k]], mesh.positions[mesh.triangles[t][k]]);
}

TEST(WriteMesh, RefusesWhatCouldNotBeReadBack) {
    const TemporaryFolder folder;
    TriangleMesh notFinite = cubeAt({0, 0, 0}, 1);
    notFinite.positions[1].y = HUGE_VALF;
    TriangleMesh badIndex = cubeAt({0, 0, 0}, 1);
    badIndex.triangles[1].z = 8;
    for (const TriangleMesh& mesh : {TriangleMesh{}, notFinite, badIndex})
        EXPECT_THROW(writeMesh(mesh, folder / "a.obj"), InvalidInput);
    EXPECT_THROW(writeMesh(cubeAt({0, 0, 0}, 1), folder / "a.ply"), InvalidInput);
    EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(WriteMesh, NamesAFolderThatIsNotThere) {
    const TemporaryFolder folder;
    const fs::path file = folder / "missing" / "a.obj";
    try {
        writeMesh(cubeAt({0, 0, 0}, 1), file);
        ADD_FAILURE() << "was written";
    } catch (const DeviceError& error) {
        EXPECT_EQ(error.subject(), file.string());
        EXPECT_THAT(error.why(), HasSubstr("No such file or directory"));
    }
}

} // namespace
} // namespace lumorph
