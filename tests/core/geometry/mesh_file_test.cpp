#include "core/geometry/mesh_file.h"

#include <bit>
#include <cstring>
#include <fstream>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/mesh_check.h"
#include "core/geometry/mesh_parsers.h"
#include "core/geometry/mesh_writers.h"
#include "tests/core/geometry/sample_meshes.h"
#include "tests/core/temporary_folder.h"

namespace lumorph {
namespace {

using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

std::span<const std::byte> bytesOf(const std::string& text) { return std::as_bytes(std::span(text)); }

template <typename Number> std::string raw(Number value, std::endian order = std::endian::little) {
    std::string bytes(sizeof(Number), '\0');
    std::memcpy(bytes.data(), &value, sizeof(Number));
    if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

// The known solid: an L-shaped prism (a dented hexagon, extruded), its sides quads. Volume 3 x 2 = 6.
constexpr int kPoints[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};

std::vector<glm::vec3> prismPoints() {
    std::vector<glm::vec3> points;
    for (const float z : {0.0F, 2.0F})
        for (const auto& p : kPoints) points.emplace_back(p[0], p[1], z);
    return points;
}

std::vector<std::vector<int>> prismFaces() {
    std::vector<std::vector<int>> faces{{5, 4, 3, 2, 1, 0}, {6, 7, 8, 9, 10, 11}};
    for (int i = 0; i < 6; ++i) faces.push_back({i, (i + 1) % 6, (i + 1) % 6 + 6, i + 6});
    return faces;
}

std::string point(const glm::vec3& p) {
    return std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z);
}

/// OBJ with everything that other programs put into it.
std::string prismObj() {
    std::string text = "# exported\nmtllib prism.mtl\no Prism\ng all sides\n";
    for (const glm::vec3& p : prismPoints()) text += "v " + point(p) + "\n";
    text += "vt 0.5 0.5\nvn 0 0 1\ns off\nusemtl paper\n";
    const char* const corners[] = {"", "/1", "//1", "/1/1"};
    std::size_t kind = 0;
    for (const std::vector<int>& face : prismFaces()) {
        text += "f";
        for (const int i : face) text += " " + std::to_string(i + 1) + corners[kind % 4];
        ++kind;
        text += "\n";
    }
    return text;
}

std::string prismObjNegative() {
    std::string text;
    for (const glm::vec3& p : prismPoints()) text += "v " + point(p) + " 0.1 0.2 0.3\n";
    for (const std::vector<int>& face : prismFaces()) {
        text += "f \\\n ";
        for (const int i : face) text += " " + std::to_string(i - 12) + "/-1/-1";
        text += " # a comment\n";
    }
    return text + "vt 0 0\nvn 0 0 1\n\n\n";
}

std::string prismObjFacesFirst() {
    std::string faces;
    for (const std::vector<int>& face : prismFaces()) {
        faces += "f";
        for (const int i : face) faces += " " + std::to_string(i + 1);
        faces += "\n";
    }
    for (const glm::vec3& p : prismPoints()) faces += "v " + point(p) + "\n";
    return faces;
}

std::string prismOff(const std::string& keyword, const std::string& vertexExtra, const std::string& faceExtra) {
    std::string text = keyword + " 12 8 0\n# points\n\n";
    for (const glm::vec3& p : prismPoints()) text += point(p) + vertexExtra + "\n";
    for (const std::vector<int>& face : prismFaces()) {
        text += std::to_string(face.size()) + " ";
        for (const int i : face) text += " " + std::to_string(i);
        text += faceExtra + "\n";
    }
    return text;
}

std::string prismPlyText() {
    std::string text = "ply\nformat ascii 1.0\ncomment by hand\nobj_info none\nelement vertex 12\nproperty uchar red\n"
                       "property float x\nproperty double y\nproperty float z\nproperty list uchar float weights\n"
                       "element material 1\nproperty int id\nelement face 8\nproperty uchar flags\n"
                       "property list uchar int vertex_index\nend_header\n";
    for (const glm::vec3& p : prismPoints()) text += "255 " + point(p) + " 2 0.5 nan\n";
    text += "7\n";
    for (const std::vector<int>& face : prismFaces()) {
        text += "1 " + std::to_string(face.size());
        for (const int i : face) text += " " + std::to_string(i);
        text += "\n";
    }
    return text;
}

template <typename Count, typename Index>
std::string prismPly(std::endian order, const std::string& countType, const std::string& indexType,
                     const std::string& newline = "\n") {
    std::string text = "ply\nformat binary_" + std::string(order == std::endian::big ? "big" : "little") +
                       "_endian 1.0\nelement vertex 12\nproperty short tag\nproperty list uchar ushort extra\n"
                       "property double x\nproperty float y\nproperty int z\nelement face 8\nproperty list " +
                       countType + " " + indexType + " vertex_indices\nproperty uchar red\nend_header\n";
    text = replaced(text, "\n", newline);
    for (const glm::vec3& p : prismPoints())
        text += raw(std::int16_t{-3}, order) + raw(std::uint8_t{2}, order) + raw(std::uint16_t{1}, order) +
                raw(std::uint16_t{2}, order) + raw(double{p.x}, order) + raw(p.y, order) +
                raw(static_cast<std::int32_t>(p.z), order);
    for (const std::vector<int>& face : prismFaces()) {
        text += raw(static_cast<Count>(face.size()), order);
        for (const int i : face) text += raw(static_cast<Index>(i), order);
        text += '\x7F';
    }
    return text;
}

TriangleMesh prism() { return parseObj(bytesOf(prismObjFacesFirst()), "prism"); }

std::string prismStlText() {
    const TriangleMesh mesh = prism();
    std::string text = "solid a name with words\n";
    for (const glm::uvec3& t : mesh.triangles) {
        text += "  facet normal nan -nan(ind) 0\n    outer loop\n";
        for (int k = 0; k < 3; ++k) text += "      vertex " + point(mesh.positions[t[k]]) + "\n";
        text += "    endloop\n  endfacet\n";
    }
    return text + "endsolid a name with words\n";
}

std::string prismStl(const std::string& head) {
    const std::vector<std::byte> bytes = writeStl(prism());
    std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return text.replace(0, 80, head + std::string(80 - head.size(), ' '));
}

struct Readable {
    const char* name;
    const char* file;
    std::string content;
};

class Formats : public testing::TestWithParam<Readable> {};

TEST_P(Formats, GiveTheSameSolid) {
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
INSTANTIATE_TEST_SUITE_P(Prism, Formats, testing::Values(
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

TEST(ObjReader, KeepsCoordinatesToTheBit) {
    const TriangleMesh mesh = parseObj(bytesOf("v 0.1 +1.5e-3 -2E2\nv 1e-60 1e-45 0\nv 16777217 .5 5.\nf 1 2 3"), "a");
    EXPECT_EQ(mesh.positions[0], glm::vec3(0.1F, 1.5e-3F, -200.0F));
    EXPECT_EQ(mesh.positions[1], glm::vec3(0.0F, 1e-45F, 0.0F)); // below the least float: zero
    EXPECT_EQ(mesh.positions[2], glm::vec3(16777216.0F, 0.5F, 5.0F));
}

TEST(ObjReader, CutsDentedPolygonsWithoutFillingTheDents) {
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

TEST(ObjReader, MakesNoFlatTrianglesOfCornersOnAStraightSide) {
    const TriangleMesh mesh =
        parseObj(bytesOf("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nv 0 2 0\nf 1 2 3 4 5 6 7"), "a");
    EXPECT_EQ(mesh.triangles.size(), 5U);
    EXPECT_EQ(checkMesh(mesh).degenerateTriangles, 0U);
}

struct Broken {
    const char* name;
    const char* file;
    std::string content;
    const char* subject; ///< what stands after the file's name: the place
    const char* why;
};

class BrokenFiles : public testing::TestWithParam<Broken> {};

TEST_P(BrokenFiles, AreRefusedWithPlaceAndCause) {
    const TemporaryFolder folder;
    const fs::path file = folder / GetParam().file;
    std::ofstream(file, std::ios::binary) << GetParam().content;
    try {
        (void)readMesh(file);
        ADD_FAILURE() << "was read";
    } catch (const DataError& error) {
        EXPECT_EQ(error.subject(), file.string() + GetParam().subject);
        EXPECT_THAT(error.why(), HasSubstr(GetParam().why));
        EXPECT_FALSE(error.remedy().empty());
    }
}

std::string plyHead(const std::string& vertices, const std::string& faces) {
    return "ply\nformat binary_little_endian 1.0\nelement vertex " + vertices +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
           "\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string plyTriangle(int index, float x = 0.0F) {
    std::string text = plyHead("3", "1");
    for (int i = 0; i < 9; ++i) text += raw(i == 3 ? x : static_cast<float>(i));
    return text + '\3' + raw(0) + raw(1) + raw(index);
}

std::string plyText(const std::string& body) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
           body;
}

std::string stlWithCount(std::uint32_t count) {
    const std::string text = prismStl("binary");
    return text.substr(0, 80) + raw(count) + text.substr(84);
}

std::string stlWithNan() {
    std::string text = prismStl("binary");
    return text.replace(84 + 2 * 50 + 12, 4, raw(std::numeric_limits<float>::quiet_NaN()));
}

const std::string kV3 = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

// clang-format off
INSTANTIATE_TEST_SUITE_P(Table, BrokenFiles, testing::Values(
    //     name                  file     content                                           place            cause
    Broken{"UnknownKind",        "a.step", "x",                                             "",              "no kind known"},
    Broken{"NoExtension",        "a",     "x",                                              "",              "no kind known"},
    Broken{"ObjEmpty",           "a.obj", "",                                               "",              "empty"},
    Broken{"ObjOnlyComments",    "a.obj", "# nothing\n",                                    "",              "holds no mesh"},
    Broken{"ObjPointsOnly",      "a.obj", kV3,                                              "",              "3 points but no faces"},
    Broken{"ObjGarbage",         "a.obj", "Lorem ipsum\n",                                  ", line 1",      "'Lorem' is not a statement"},
    Broken{"ObjBinaryGarbage",   "a.obj", std::string("\x89PNG\r\n\x1A\n\xFF\xFE", 10),     ", line 1",      "'?PNG' is not a statement"},
    Broken{"ObjIndexTooLarge",   "a.obj", kV3 + "f 1 2 4\n",                                ", line 4",      "vertex 3 (counted from 0), but the file has 3"},
    Broken{"ObjIndexZero",       "a.obj", kV3 + "\nf 0 1 2\n",                              ", line 5",      "vertex 0"},
    Broken{"ObjIndexNegative",   "a.obj", kV3 + "f -1 -2 -4\n",                             ", line 4",      "vertex -4"},
    Broken{"ObjIndexHuge",       "a.obj", kV3 + "f 1 2 99999999999999999999\n",             ", line 4",      "not a whole number"},
    Broken{"ObjTwoCorners",      "a.obj", kV3 + "f 1 2\n",                                  ", line 4",      "a face has 2 corners"},
    Broken{"ObjCornerGarbage",   "a.obj", kV3 + "f 1 2 3/x\n",                              ", line 4",      "'3/x' is not a corner"},
    Broken{"ObjNan",             "a.obj", "v 0 nan 0\n",                                    ", line 1",      "y coordinate is 'nan'"},
    Broken{"ObjInfinite",        "a.obj", "v 0 0 -inf\n",                                   ", line 1",      "z coordinate is '-inf'"},
    Broken{"ObjTooFar",          "a.obj", "v 1e39 0 0\n",                                   ", line 1",      "x coordinate is '1e39'"},
    Broken{"ObjDecimalComma",    "a.obj", "#\r\n#\r\nv 0,5 0 0\n",                          ", line 3",      "'0,5' is not a number"},
    Broken{"ObjTruncated",       "a.obj", kV3 + "v 0.5 0.",                                 ", line 4",      "ends where the z coordinate"},
    Broken{"ObjAfterContinued",  "a.obj", kV3 + "f 1 \\\n2 \\\n3\nf 1 2 9\n",               ", line 7",      "vertex 8"},
    Broken{"ObjMissing",         "a.obj", "v 1 2\nv 3 4 5\n",                                 ", line 1",      "z coordinate is missing"},
    Broken{"OffEmpty",           "a.off", "",                                               "",              "empty"},
    Broken{"OffWrongKeyword",    "a.off", "FOO\n1 2 3\n",                                   ", line 1",      "begin with OFF"},
    Broken{"OffBinary",          "a.off", std::string("OFF BINARY\n\0\0\0\x08", 15),        ", line 1",      "binary OFF"},
    Broken{"OffFourDimensions",  "a.off", "4OFF\n1 0 0\n0 0 0 1\n",                         ", line 1",      "not three-dimensional"},
    Broken{"OffHugeCounts",      "a.off", "OFF\n4000000000 4000000000 0\n0 0 0\n",          ", line 4",      "vertex 2 of 4000000000"},
    Broken{"OffNegativeCount",   "a.off", "OFF\n-3 1 0\n",                                  ", line 2",      "is negative"},
    Broken{"OffHugePolygon",     "a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n", ", line 7", "corner of face 1"},
    Broken{"OffIndexTooLarge",   "a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",     ", line 6",      "vertex 3 (counted from 0)"},
    Broken{"OffIndexNegative",   "a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n",    ", line 6",      "vertex -1"},
    Broken{"OffNan",             "a.off", "OFF\n3 1 0\n0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n",   ", line 4",      "x coordinate is 'nan'"},
    Broken{"OffTooMuch",         "a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 2\n", ", line 7", "after the last of 1 faces"},
    Broken{"OffTruncated",       "a.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",     ", line 7",      "face 2 of 2"},
    Broken{"PlyEmpty",           "a.ply", "",                                               "",              "empty"},
    Broken{"PlyWrongKeyword",    "a.ply", "plyx\n",                                         ", line 1",      "begin with 'ply'"},
    Broken{"PlyUnknownFormat",   "a.ply", "ply\nformat ebcdic 1.0\n",                       ", line 2",      "'ebcdic' is not known"},
    Broken{"PlyVersion",         "a.ply", "ply\nformat ascii 2.0\n",                        ", line 2",      "version '2.0'"},
    Broken{"PlyHeadTruncated",   "a.ply", "ply\nformat ascii 1.0\nelement vertex 3\n",      ", line 4",      "'end_header'"},
    Broken{"PlyUnknownType",     "a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty quad x\n", ", line 4", "'quad' is not a type"},
    Broken{"PlyFloatLength",     "a.ply", "ply\nformat ascii 1.0\nelement face 3\nproperty list float int vertex_indices\n", ", line 4", "length is not an integer"},
    Broken{"PlyHugeCount",       "a.ply", plyHead("4000000000", "1") + std::string(100, 'x'), "",            "4000000000 times 'vertex'"},
    Broken{"PlyHugeFaceCount",   "a.ply", plyHead("0", "99999999999999") + std::string(100, 'x'), "",        "99999999999999 times 'face'"},
    Broken{"PlyHugeList",        "a.ply", plyTriangle(2).replace(plyTriangle(2).size() - 13, 1, "\xFF"), "", "ends inside its data"},
    Broken{"PlyIndexTooLarge",   "a.ply", plyTriangle(3),                                   ", face 1",      "vertex 3 (counted from 0)"},
    Broken{"PlyIndexNegative",   "a.ply", plyTriangle(-1),                                  ", face 1",      "vertex -1"},
    Broken{"PlyInfinite",        "a.ply", plyTriangle(2, HUGE_VALF),                        ", vertex 2",    "not a finite number"},
    Broken{"PlyTruncated",       "a.ply", plyTriangle(2).substr(0, plyTriangle(2).size() - 1), "",           "ends inside its data"},
    Broken{"PlyTooMuch",         "a.ply", plyTriangle(2) + "more",                          "",              "more data follows"},
    Broken{"PlyTextNan",         "a.ply", plyText("0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"),      ", line 11",     "not a finite number"},
    Broken{"PlyTextWord",        "a.ply", plyText("0 0 0\n1 0 0\n0 x 0\n3 0 1 2\n"),        ", line 12",     "'x' is not a number"},
    Broken{"PlyTextFraction",    "a.ply", plyText("0 0 0\n1 0 0\n0 1 0\n3 0 1 1.5\n"),      ", line 13",     "not a whole number"},
    Broken{"PlyTextTruncated",   "a.ply", plyText("0 0 0\n1 0 0\n0 1 0\n3 0 1"),            ", line 13",     "the file ends"},
    Broken{"PlyPointsOnly",      "a.ply", plyHead("1", "0") + std::string(12, '\0'),        "",              "1 points but no faces"},
    Broken{"PlyNoPosition",      "a.ply", replaced(plyTriangle(2), "float z", "float w"),   "",              "no x, y and z"},
    Broken{"StlEmpty",           "a.stl", "",                                               "",              "empty"},
    Broken{"StlShort",           "a.stl", "garbage",                                        "",              "too short"},
    Broken{"StlNoTriangles",     "a.stl", "solid nothing\nendsolid\n",                      "",              "holds no mesh"},
    Broken{"StlTruncated",       "a.stl", prismStl("binary").substr(0, 500),                "",              "promises 20 triangles"},
    Broken{"StlCountTooSmall",   "a.stl", stlWithCount(19),                                 "",              "promises 19 triangles"},
    Broken{"StlCountHuge",       "a.stl", stlWithCount(0xFFFFFFFFU),                        "",              "promises 4294967295 triangles"},
    Broken{"StlNan",             "a.stl", stlWithNan(),                                     ", triangle 3",  "not a finite number"},
    Broken{"StlTextTruncated",   "a.stl", prismStlText().substr(0, 500),                    ", line 19",     "the file ends"},
    Broken{"StlTextNoEnd",       "a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n", ", line 9", "the file ends"},
    Broken{"StlTextQuad",        "a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\n", ", line 7", "expected 'endloop', found 'vertex'"},
    Broken{"StlTextWord",        "a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 zero 0\n", ", line 4", "'zero' is not a number"}),
    [](const auto& test) { return std::string(test.param.name); });
// clang-format on

TEST(ReadMesh, NamesAFileThatCannotBeRead) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "folder.obj");
    for (const char* const name : {"missing.stl", "folder.obj"}) {
        try {
            (void)readMesh(folder / name);
            ADD_FAILURE() << name << " was read";
        } catch (const DataError& error) {
            EXPECT_EQ(error.subject(), (folder / name).string());
        }
    }
}

TEST(ReadMesh, RefusesMoreTrianglesThanTheLimit) {
    std::string stl(80, ' ');
    stl += raw(static_cast<std::uint32_t>(kMaxTriangles + 1));
    stl.resize(84 + 50 * (kMaxTriangles + 1));
    try {
        (void)parseStl(bytesOf(stl), "large.stl");
        ADD_FAILURE() << "was read";
    } catch (const DataError& error) {
        EXPECT_THAT(error.why(), HasSubstr("limit of 10000000"));
    }
}

TEST(ReadMesh, RefusesAPolygonOfTooManyCorners) {
    std::string text = kV3 + "f";
    for (int i = 0; i < 3334; ++i) text += " 1 2 3";
    try {
        (void)parseObj(bytesOf(text), "a.obj");
        ADD_FAILURE() << "was read";
    } catch (const DataError& error) {
        EXPECT_EQ(error.subject(), "a.obj, line 4");
        EXPECT_THAT(error.why(), HasSubstr("10002 corners"));
    }
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
