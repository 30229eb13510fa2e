#include "core/geometry/mesh_file.h"

#include <cmath>
#include <fstream>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/core/geometry/sample_mesh_files.h"
#include "tests/core/temporary_folder.h"

namespace lumorph {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

struct Broken {
    const char* name;
    const char* file;
    std::string content;
    const char* subject; ///< what stands after the file's name: the place
    const char* why;
};

class ReadMeshBrokenFiles : public testing::TestWithParam<Broken> {};

TEST_P(ReadMeshBrokenFiles, AreRefusedWithPlaceAndCause) {
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

/// A triangle and many faces; what stands for these cannot be read, so that only the head can tell.
std::string plyRepeats() {
    return plyHead("3", "20000") + std::string(36, '\0') + std::string(std::size_t{20'000} * 13, '\xFF');
}

std::string repeated(const std::string& text, int count) {
    std::string all;
    for (int i = 0; i < count; ++i) all += text;
    return all;
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
INSTANTIATE_TEST_SUITE_P(Table, ReadMeshBrokenFiles, testing::Values(
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
    Broken{"ObjRepeats",         "a.obj", kV3 + repeated("f 1 2 3\n", 20'000),              "",              "20000 faces on 3 vertices"},
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
    Broken{"PlyRepeats",         "a.ply", plyRepeats(),                                     ", its head",    "20000 faces on 3 vertices"},
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

} // namespace
} // namespace lumorph
